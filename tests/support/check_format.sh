#!/usr/bin/env bash
# Every C++ source is formatted as .clang-format says. Usage: check_format.sh <sources>
set -euo pipefail
command -v clang-format >/dev/null || { echo "SKIPPED: clang-format is not installed"; exit 77; }
exec "$1/scripts/lint" --format-only
