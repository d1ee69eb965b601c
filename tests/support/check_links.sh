#!/usr/bin/env bash
# Neither OpenCV's windows nor GLFW come with what we build, at any depth.
# Usage: check_links.sh <library or program...>
set -euo pipefail
command -v readelf >/dev/null || { echo "SKIPPED: readelf (package binutils) is not installed"; exit 77; }
unwanted='opencv_(highgui|videoio|calib3d)|glfw|libGL\b|libX11|libQt|libgtk'
for file in "$@"; do
    case $file in
        *.a)
            if nm -C --undefined-only "$file" | grep -E 'cv::(imshow|waitKey|namedWindow|VideoCapture)|glfw'; then
                echo "FAILED: $file uses a window"
                exit 1
            fi
            ;;
        *)
            # What it names itself; what Debian's image codecs drag in behind is theirs.
            if readelf -d "$file" | grep NEEDED | grep -E "$unwanted"; then
                echo "FAILED: $file links a window library"
                exit 1
            fi
            if ldd "$file" | grep -E 'opencv_highgui|glfw'; then
                echo "FAILED: $file loads a window library"
                exit 1
            fi
            ;;
    esac
done
