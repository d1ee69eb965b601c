#!/usr/bin/env bash
# Installs a build to a temporary prefix, then builds and runs tests/install/consumer against it.
# Usage: check_install.sh find_package|pkg_config <cmake> <build> <C++ compiler>
set -euo pipefail
way=$1 cmake=$2 build=$3 compiler=$4
consumer=$(cd "$(dirname "$0")/consumer" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
prefix=$work/prefix

"$cmake" --install "$build" --prefix "$prefix" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
libraries=$(dirname "$(find "$prefix" -name 'libxtrack_core.*' | head -n 1)")

case $way in
    find_package)
        "$cmake" -S "$consumer" -B "$work/consumer" -G Ninja "-DCMAKE_PREFIX_PATH=$prefix" \
            "-DCMAKE_CXX_COMPILER=$compiler" -DCMAKE_BUILD_TYPE=Release >"$work/log" 2>&1 &&
            "$cmake" --build "$work/consumer" >>"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
        program=$work/consumer/consumer
        # The first program of the README builds against the installed libraries, too.
        "$cmake" -S "$consumer/../../../examples/hello" -B "$work/hello" -G Ninja \
            "-DCMAKE_PREFIX_PATH=$prefix" "-DCMAKE_CXX_COMPILER=$compiler" >"$work/log" 2>&1 &&
            "$cmake" --build "$work/hello" >>"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
        ;;
    pkg_config)
        command -v pkg-config >/dev/null || { echo "SKIPPED: pkg-config is not installed"; exit 77; }
        program=$work/program
        export PKG_CONFIG_PATH=$libraries/pkgconfig
        # shellcheck disable=SC2046
        "$compiler" -std=c++20 -O2 -march=native "$consumer/main.cpp" -o "$program" \
            $(pkg-config --cflags --libs xtrack-gestures)
        ;;
esac
out=$(LD_LIBRARY_PATH=$libraries "$program")
[ "$out" = right ] || { echo "FAILED: the consumer printed '$out'"; exit 1; }

# The installed command runs from where it was put.
if [ -x "$prefix/bin/xtrack" ]; then
    LD_LIBRARY_PATH=$libraries "$prefix/bin/xtrack" --help >/dev/null
fi
