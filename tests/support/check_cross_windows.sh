#!/usr/bin/env bash
# What needs no OpenCV builds for Windows: the libraries, and a program that links them whole.
# Usage: check_cross_windows.sh <sources> <build folder>
set -euo pipefail
sources=$1
build=$2
for tool in x86_64-w64-mingw32-g++-posix cmake ninja; do
    command -v $tool >/dev/null || { echo "SKIPPED: $tool is missing (scripts/packages.debian, cross)"; exit 77; }
done
mkdir -p "$build"
# libhwy is not packaged for Windows, so the kernels are the scalar ones.
cmake -S "$sources" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE=-O1 \
    --toolchain "$sources/cmake/toolchains/mingw-w64.cmake" \
    -DXTRACK_WITH_OPENCV=OFF -DXTRACK_WITH_TOOLS=OFF -DXTRACK_WITH_HIGHWAY=OFF \
    -DXTRACK_WITH_TESTS=OFF -DXTRACK_DEVELOPER=ON >"$build/log" 2>&1 || { cat "$build/log"; exit 1; }
cmake --build "$build" >"$build/log" 2>&1 || { tail -n 40 "$build/log"; exit 1; }
x86_64-w64-mingw32-g++-posix -std=c++20 -O1 -static -isystem /usr/include/eigen3 \
    -I"$sources/core/include" -I"$sources/gestures/include" \
    "$sources/tests/install/consumer/main.cpp" -o "$build/consumer.exe" -Wl,--whole-archive \
    "$build/gestures/libxtrack_gestures.a" "$build/core/libxtrack_core.a" -Wl,--no-whole-archive
file=$(od -A n -t c -N 2 "$build/consumer.exe" | tr -d ' ')
[ "$file" = MZ ] || { echo "FAILED: consumer.exe is not a Windows program"; exit 1; }
