#!/usr/bin/env bash
# A stage that includes a later stage fails the build: copies the build files and three tiny
# stages, builds them, then lets them break the order in every way there is.
# Usage: check_stage_order.sh <sources> <cmake>
set -euo pipefail
sources=$1
cmake=$2
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT

cp -r "$sources/cmake" "$tree/cmake"
cp "$sources/CMakeLists.txt" "$sources/LICENSE" "$tree/"
mkdir -p "$tree"/core/{decode,depth,include/xtrack} "$tree"/gestures/{track,include/xtrack}
cp "$sources/core/CMakeLists.txt" "$tree/core/"
cp "$sources/gestures/CMakeLists.txt" "$tree/gestures/"
cp "$sources/core/include/xtrack/stamp.hpp" "$tree/core/include/xtrack/"
for stage in core/decode core/depth gestures/track; do
    name=$(basename "$stage")
    echo "xtrack_stage($stage SOURCES $name.cpp)" >"$tree/$stage/CMakeLists.txt"
    printf '#pragma once\nint %s();\n' "$name" >"$tree/$stage/$name.hpp"
    printf '#include "%s/%s.hpp"\n\n#include <xtrack/stamp.hpp>\n\nint %s() { return 1; }\n' \
        "$stage" "$name" "$name" >"$tree/$stage/$name.cpp"
done
printf '#pragma once\n' >"$tree/gestures/include/xtrack/hand.hpp"

build() {
    "$cmake" -S "$tree" -B "$tree/build" -G Ninja -DXTRACK_WITH_OPENCV=OFF -DXTRACK_WITH_TOOLS=OFF \
        -DXTRACK_WITH_HIGHWAY=OFF -DXTRACK_WITH_TESTS=OFF >"$tree/log" 2>&1 &&
        "$cmake" --build "$tree/build" >>"$tree/log" 2>&1
}

# refused <file> <line to put first> <what the build must say>
refused() {
    cp "$tree/$1" "$tree/saved"
    { echo "$2"; cat "$tree/saved"; } >"$tree/$1"
    if build; then
        echo "FAILED: the build accepted '$2' in $1"
        exit 1
    fi
    if ! grep -qF -- "$3" "$tree/log"; then
        echo "FAILED: the build refused '$2' in $1, but did not say: $3"
        cat "$tree/log"
        exit 1
    fi
    cp "$tree/saved" "$tree/$1"
}

build || { echo "FAILED: stages in order must build"; cat "$tree/log"; exit 1; }
# An earlier stage is welcome.
sed -i '1i #include "core/decode/decode.hpp"' "$tree/core/depth/depth.cpp"
build || { echo "FAILED: an earlier stage must be allowed"; cat "$tree/log"; exit 1; }

refused core/decode/decode.cpp '#include "core/depth/depth.hpp"' \
    'core/decode/decode.cpp:1: error: stage core/decode includes "core/depth/depth.hpp" of the later stage core/depth'
refused core/decode/decode.hpp '#  include "core/depth/depth.hpp"' 'of the later stage core/depth'
refused core/depth/depth.cpp '#include <xtrack/hand.hpp>' \
    'includes "xtrack/hand.hpp" of the later stage gestures/'
refused core/depth/depth.cpp '#include "gestures/track/track.hpp"' 'of the later stage gestures/track'
refused core/include/xtrack/stamp.hpp '#include <xtrack/hand.hpp>' \
    'core/include/xtrack/stamp.hpp:1: error: stage core/base includes "xtrack/hand.hpp"'
refused core/decode/decode.cpp '#include "../depth/depth.hpp"' 'from the root of the project'
refused core/decode/decode.cpp '#include "tools/xtrack/run.hpp"' 'which stands on the stages'
touch "$tree/core/include/xtrack/unlisted.hpp"
if build; then
    echo "FAILED: the build accepted a public header of no stage"
    exit 1
fi
grep -qF 'core/include/xtrack/unlisted.hpp:1: error: a public header of no stage' "$tree/log"
rm "$tree/core/include/xtrack/unlisted.hpp"
build || { echo "FAILED: mended again, the stages must build"; cat "$tree/log"; exit 1; }
echo "eight ways against the order, eight refusals"
