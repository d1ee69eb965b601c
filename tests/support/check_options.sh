#!/usr/bin/env bash
# Options mean what they say: one for a part that this version does not have is refused with a
# sentence, and what is left out is not in the build.
# Usage: check_options.sh <sources> <cmake>
set -euo pipefail
sources=$1
cmake=$2
build=$(mktemp -d)
trap 'rm -rf "$build"' EXIT

configure() {
    "$cmake" -S "$sources" -B "$build" -G Ninja -DXTRACK_WITH_TESTS=OFF "$@" >"$build/log" 2>&1
}

while read -r option folder; do
    if [ -e "$sources/$folder/CMakeLists.txt" ]; then
        configure "-D$option=OFF" || { cat "$build/log"; exit 1; }
        if grep -q "$folder" "$build/build.ninja"; then
            echo "FAILED: $option=OFF still builds $folder"
            exit 1
        fi
        rm -rf "${build:?}"/*
    elif configure "-D$option=ON"; then
        echo "FAILED: $option=ON was accepted, but there is no $folder"
        exit 1
    elif ! tr -s '\n ' ' ' <"$build/log" | grep -q "$option=ON: .* is not part of xTrack"; then
        echo "FAILED: $option=ON is refused without saying why"
        cat "$build/log"
        exit 1
    fi
    rm -f "$build/CMakeCache.txt"
done <<LIST
XTRACK_WITH_CALIBRATION core/calibrate
XTRACK_WITH_V4L2 core/capture/v4l2
XTRACK_WITH_PROJECTOR core/project
XTRACK_WITH_HID gestures/hid
XTRACK_WITH_BINDINGS bindings
LIST

configure -DXTRACK_WITH_OPENCV=OFF || { cat "$build/log"; exit 1; }
if grep -qi opencv "$build/build.ninja"; then
    echo "FAILED: XTRACK_WITH_OPENCV=OFF still uses OpenCV"
    exit 1
fi
if grep -q 'bin/xtrack' "$build/build.ninja"; then
    echo "FAILED: without OpenCV there can be no command"
    exit 1
fi
if configure -DXTRACK_WITH_OPENCV=OFF -DXTRACK_WITH_TOOLS=ON; then
    echo "FAILED: tools without OpenCV were accepted"
    exit 1
fi
