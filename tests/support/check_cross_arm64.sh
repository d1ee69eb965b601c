#!/usr/bin/env bash
# What needs no OpenCV builds for arm64, and its unit tests pass there (under qemu-user).
# Usage: check_cross_arm64.sh <sources> <build folder>
set -euo pipefail
sources=$1
build=$2
for tool in aarch64-linux-gnu-g++ qemu-aarch64 cmake ninja ctest; do
    command -v $tool >/dev/null || { echo "SKIPPED: $tool is missing (scripts/packages.debian, cross)"; exit 77; }
done
for file in libgmock.a libhwy.so; do
    [ -e /usr/lib/aarch64-linux-gnu/$file ] || { echo "SKIPPED: $file for arm64 is missing (scripts/packages.debian, cross)"; exit 77; }
done
mkdir -p "$build"
# Emulated, a test takes ten times as long; -O1 costs less to compile than it loses there.
cmake -S "$sources" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE=-O1 \
    --toolchain "$sources/cmake/toolchains/aarch64-linux-gnu.cmake" \
    -DXTRACK_WITH_OPENCV=OFF -DXTRACK_WITH_TOOLS=OFF -DXTRACK_WITH_TESTS=ON -DXTRACK_DEVELOPER=ON \
    >"$build/log" 2>&1 || { cat "$build/log"; exit 1; }
cmake --build "$build" >"$build/log" 2>&1 || { tail -n 40 "$build/log"; exit 1; }
ctest --test-dir "$build" -L '^unit$' --no-tests=error --output-on-failure --timeout 120 \
    -j "${CTEST_PARALLEL_LEVEL:-2}" >"$build/log" 2>&1 || { tail -n 60 "$build/log"; exit 1; }
tail -n 5 "$build/log"
