#!/usr/bin/env bash
# The Point Cloud Library reads what `decode --export` writes: the same points from PLY, PCD and OBJ.
# Usage: check_pcl.sh <xtrack> <fringe recording>
set -euo pipefail
for tool in pcl_ply2pcd pcl_convert_pcd_ascii_binary pcl_obj2ply; do
    command -v $tool >/dev/null || { echo "SKIPPED: $tool (package pcl-tools) is not installed"; exit 77; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$1" decode "$2" --out "$work/out" --export ply,pcd,obj >/dev/null
cd "$work/out"

fail() {
    echo "FAILED: $*"
    exit 1
}
# points <pcd>: x y z and colour as text, without the header
points() {
    pcl_convert_pcd_ascii_binary "$1" "$1.txt" 0 >"$work/said" 2>&1 || { cat "$work/said"; fail "PCL cannot read $1"; }
    grep -q '^FIELDS x y z rgb' "$1.txt" || fail "PCL sees other fields in $1: $(grep ^FIELDS "$1.txt")"
    sed '1,/^DATA/d' "$1.txt"
}
pcl_ply2pcd cloud.ply ply.pcd >"$work/said" 2>&1 || { cat "$work/said"; fail "PCL cannot read cloud.ply"; }
points ply.pcd >ply.txt
points cloud.pcd >pcd.txt
count=$(wc -l <pcd.txt)
[ "$count" -gt 1000 ] || fail "PCL reads only $count points"
cmp ply.txt pcd.txt || fail "PCL reads other points from the PCD than from the PLY"

pcl_obj2ply mesh.obj mesh.ply >"$work/said" 2>&1 || { cat "$work/said"; fail "PCL cannot read mesh.obj"; }
[ "$(grep -a -m1 '^element vertex' mesh.ply)" = "element vertex $count" ] || fail "PCL reads other vertices from the mesh"
faces=$(grep -c '^f ' mesh.obj)
[ "$(grep -a -m1 '^element face' mesh.ply)" = "element face $faces" ] || fail "PCL reads other triangles from the mesh"
echo "PCL reads $count points and $faces triangles"
