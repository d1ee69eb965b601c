#!/usr/bin/env bash
# Rules of the sources that no compiler checks.
# Usage: check_sources.sh <sources>
set -euo pipefail
cd "$1"
failed=0

# forbid <why> <extended regular expression> <path...>: no C++ source under the paths matches.
forbid() {
    local why=$1 pattern=$2 found
    shift 2
    found=$(grep -rnE --include='*.hpp' --include='*.cpp' --include='*.h' -- "$pattern" "$@" || true)
    if [ -n "$found" ]; then
        printf 'FAILED: %s\n%s\n' "$why" "$found"
        failed=1
    fi
}

code=()
for folder in core gestures tools tests examples bindings; do
    [ -d "$folder" ] && code+=("$folder")
done
include='^[[:space:]]*#[[:space:]]*include[[:space:]]*'

forbid "OpenCV by module, not the umbrella header" "${include}[<\"]opencv2/opencv\.hpp" "${code[@]}"
forbid "OpenCV's windows and cameras are not used" "${include}[<\"]opencv2/(highgui|videoio)" "${code[@]}"
forbid "public headers stand alone from OpenCV" "${include}[<\"]opencv" core/include gestures/include

# Only device folders may know an operating system.
devices=$(sed -n 's/^set(XTRACK_DEVICE_FOLDERS \(.*\))$/\1/p' cmake/Stages.cmake | tr ' ' '|')
[ -n "$devices" ] || { echo "FAILED: cmake/Stages.cmake names no device folders"; exit 1; }
system='(unistd|pthread|fcntl|dirent|dlfcn|poll|sched|semaphore|signal|spawn|syslog|termios|windows|winsock2|sys/[a-z_]+|linux/[a-z_0-9]+|arpa/[a-z]+|netinet/[a-z]+|asm/[a-z]+)\.h'
found=$(grep -rnE --include='*.hpp' --include='*.cpp' --include='*.h' -- "${include}<$system>" core gestures |
    grep -vE "^($devices)/" || true)
if [ -n "$found" ]; then
    printf 'FAILED: a header of an operating system outside the device folders (%s)\n%s\n' "$devices" "$found"
    failed=1
fi

# Time is an argument: clocks are read where threads live, and by devices.
found=$(grep -rnE --include='*.hpp' --include='*.cpp' -- '_clock::now|clock_gettime|gettimeofday' core gestures |
    grep -vE "^(core|gestures)/pipeline/|^($devices)/" || true)
if [ -n "$found" ]; then
    printf 'FAILED: a clock is read outside pipeline/\n%s\n' "$found"
    failed=1
fi
found=$(grep -rnE --include='*.hpp' --include='*.cpp' -- 'std::(j?thread|async)\b' core gestures |
    grep -vE '^(core|gestures)/pipeline/' || true)
if [ -n "$found" ]; then
    printf 'FAILED: a thread outside pipeline/\n%s\n' "$found"
    failed=1
fi

# A library leaves ending the process to its user. std::terminate is refused here only: the compiler
# itself asks for that symbol, so check_symbols.sh cannot. Comments may speak of it.
found=$(grep -rnE --include='*.hpp' --include='*.cpp' --include='*.h' -- \
    '(^|[^A-Za-z0-9_.>])(terminate|abort|exit|_exit|_Exit|quick_exit)[[:space:]]*\(' core gestures |
    grep -vE '^[^:]+:[0-9]+:[[:space:]]*(//|\*)' || true)
if [ -n "$found" ]; then
    printf 'FAILED: a library ends the process\n%s\n' "$found"
    failed=1
fi

# Every source says its licence; every header is guarded.
while IFS= read -r file; do
    if ! head -n 1 "$file" | grep -q '^// SPDX-License-Identifier: Apache-2.0$'; then
        echo "FAILED: $file: the first line is not the SPDX licence line"
        failed=1
    fi
    case $file in
        # Highway includes a header once for each instruction set: it has a guard of its own.
        *.hpp) grep -qE '^#pragma once$|HWY_TARGET_TOGGLE' "$file" || { echo "FAILED: $file: no #pragma once"; failed=1; } ;;
    esac
done < <(find "${code[@]}" -name '*.cpp' -o -name '*.hpp' -o -name '*.h')

exit $failed
