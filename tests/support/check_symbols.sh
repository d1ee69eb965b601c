#!/usr/bin/env bash
# The libraries never print, exit or abort: no object of theirs asks for a symbol that does.
# Usage: check_symbols.sh <library...>
set -euo pipefail
command -v nm >/dev/null || { echo "SKIPPED: nm (package binutils) is not installed"; exit 77; }

# printing | leaving. snprintf writes to memory and is fine. std::terminate() is what the compiler puts
# behind noexcept and behind std::thread's destructor; check_sources.sh refuses a call of our own.
forbidden='(__)?(v|f|vf|d|vd)?printf(_chk)?|f?puts|f?putc|putchar|putc(har)?_unlocked|perror|fwrite(_unlocked)?'
forbidden+='|stdout|stderr|std::(w?cout|w?cerr|w?clog)|std::ostream::.*cout'
forbidden+='|_?exit|_Exit|quick_exit|abort|raise|std::__glibcxx_assert_fail\(.*|hwy::Abort\(.*'
status=0
for library in "$@"; do
    flags=-C
    case $library in *.so*) flags='-C -D' ;; esac
    # shellcheck disable=SC2086
    symbols=$(nm $flags --undefined-only "$library" | awk -v object="$library:" '/:$/ {object = $0} $1 == "U" {sub(/^ *U /, ""); sub(/@.*/, ""); print object " " $0}')
    [ -n "$symbols" ] || { echo "FAILED: nm reads nothing from $library"; exit 1; }
    found=$(printf '%s\n' "$symbols" | grep -E ": ($forbidden)\$" || true)
    if [ -n "$found" ]; then
        printf 'FAILED: %s prints or leaves the process:\n%s\n' "$library" "$found"
        status=1
    fi
    # A build without NDEBUG keeps assert(); what users get must not.
    if printf '%s\n' "$symbols" | grep -qE ': __assert_fail$'; then
        case ${XTRACK_ASSERTS:-} in
            on) ;;
            *) echo "FAILED: $library asserts in a build without asserts"; status=1 ;;
        esac
    fi
done
exit $status
