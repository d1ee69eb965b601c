#!/usr/bin/env bash
# The libraries as shared ones: they build, carry a version in their name, and a consumer runs.
# Usage: check_shared.sh <sources> <cmake> <build> <C++ compiler>
set -euo pipefail
sources=$1 cmake=$2 build=$3 compiler=$4
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$build"
# The same flags as the release build with warnings as errors: objects are position independent in
# both, so ccache gives back what that build compiled.
"$cmake" -S "$sources" -B "$build" -G Ninja -DBUILD_SHARED_LIBS=ON -DCMAKE_BUILD_TYPE=Release \
    "-DCMAKE_CXX_COMPILER=$compiler" -DXTRACK_DEVELOPER=ON -DXTRACK_WITH_TESTS=OFF -DXTRACK_WITH_TOOLS=OFF >"$build/log" 2>&1 &&
    "$cmake" --build "$build" >>"$build/log" 2>&1 || { tail -n 50 "$build/log"; exit 1; }
for part in core gestures; do
    library=$(find "$build" -name "libxtrack_$part.so")
    name=$(readelf -d "$library" | sed -n 's/.*SONAME.*\[\(.*\)\]/\1/p')
    case $name in
        libxtrack_$part.so.[0-9]*.[0-9]*) ;;
        *) echo "FAILED: SONAME of $library is '$name'"; exit 1 ;;
    esac
done
find "$build" -name 'libxtrack_*.so' -exec "$(dirname "$here")/support/check_links.sh" {} +
"$here/check_install.sh" find_package "$cmake" "$build" "$compiler"
"$here/check_install.sh" pkg_config "$cmake" "$build" "$compiler"
