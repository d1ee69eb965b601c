#!/usr/bin/env bash
# scripts/demo and scripts/test on systems that are not like this one: without apt, without sudo,
# with nobody to ask. Usage: check_scripts.sh <sources>
set -euo pipefail
sources=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/bin" "$work/tree"
cp -r "$sources/scripts" "$work/tree/scripts"
# A system with these commands and no others; `id` says who we are.
for tool in bash env awk grep tr dirname head sed cat sort mktemp tee rm nproc; do
    ln -s "$(command -v $tool)" "$work/bin/$tool"
done
printf '#!/bin/sh\necho "${FAKE_ID:-1000}"\n' >"$work/bin/id"
chmod +x "$work/bin/id"

# expect <exit status> <text> <argument...>: runs scripts/demo (or $script) there
expect() {
    local status=$1 text=$2 got=0
    shift 2
    env -i PATH="$work/bin" HOME="$work" FAKE_ID="${FAKE_ID:-1000}" "$work/tree/scripts/${script:-demo}" "$@" \
        >"$work/out" 2>&1 </dev/null || got=$?
    if [ "$got" != "$status" ] || ! grep -qF -- "$text" "$work/out"; then
        echo "FAILED: scripts/${script:-demo} $*: exit $got, want $status and '$text' in:"
        cat "$work/out"
        exit 1
    fi
}

expect 0 'usage: scripts/demo' --help
expect 2 'usage: scripts/demo' --nonsense
# Without apt: everything is named, nothing is tried.
expect 1 'libopencv-imgcodecs-dev'
expect 1 'Missing commands: cmake ninja c++'
expect 1 'This system has no apt' --yes
grep -q libgtest-dev "$work/out" && { echo "FAILED: the demo asks for what only tests need"; exit 1; }
# --no-install goes straight to the build, which here has no cmake.
expect 127 'cmake' --no-install

# With apt that has nothing installed, and records what it is asked for.
printf '#!/bin/sh\nexit 1\n' >"$work/bin/dpkg-query"
printf '#!/bin/sh\necho "apt-get $*" >>"%s/apt"\n[ "$FAKE_APT" != fails ]\n' "$work" >"$work/bin/apt-get"
chmod +x "$work/bin/dpkg-query" "$work/bin/apt-get"
expect 1 'As root, run: apt-get install'
printf '#!/bin/sh\nexec "$@"\n' >"$work/bin/sudo"
chmod +x "$work/bin/sudo"
expect 1 'Nobody to ask'
[ ! -e "$work/apt" ] || { echo "FAILED: apt-get was run without consent"; exit 1; }
expect 127 'Missing packages:' --yes
grep -q 'install .*libeigen3-dev' "$work/apt" || { echo "FAILED: --yes installed nothing"; exit 1; }
grep -q update "$work/apt" && { echo "FAILED: apt-get update was not needed"; exit 1; }
rm "$work/apt"
FAKE_ID=0 expect 127 'Missing packages:'
[ -e "$work/apt" ] || { echo "FAILED: root was asked"; exit 1; }

# The tests also want libraries of another architecture.
printf '#!/bin/sh\necho "dpkg $*" >>"%s/apt"\n' "$work" >"$work/bin/dpkg"
chmod +x "$work/bin/dpkg"
script='test' expect 127 'libhwy-dev:arm64' --yes
grep -q 'dpkg --add-architecture arm64' "$work/apt" || { echo "FAILED: no foreign architecture"; exit 1; }

# With everything installed apt is not called at all.
rm "$work/apt"
printf '#!/bin/sh\necho installed\n' >"$work/bin/dpkg-query"
expect 127 'cmake'
[ ! -e "$work/apt" ] || { echo "FAILED: apt-get was run with nothing missing"; exit 1; }

# scripts/test closes with what ctest said of every run, and fails with whatever fails first.
printf '#!/bin/sh\n[ "$*" != "$(cat %s/failing)" ]\n' "$work" >"$work/bin/cmake"
cat >"$work/bin/ctest" <<FAKE
#!/bin/sh
[ "\$*" = "\$(cat $work/failing)" ] && echo '86% tests passed, 1 tests failed out of 7' && exit 8
echo '100% tests passed, 0 tests failed out of 7'
FAKE
chmod +x "$work/bin/cmake" "$work/bin/ctest"
echo nothing >"$work/failing"
script='test' expect 0 'tsan: 100% tests passed, 0 tests failed out of 7'
for preset in release asan tsan; do
    echo "--preset $preset" >"$work/failing"
    script='test' expect 8 '86% tests passed, 1 tests failed out of 7'
    echo "--build --preset $preset" >"$work/failing"
    script='test' expect 1 "$preset: build"
    grep -q 'all passed' "$work/out" && { echo "FAILED: a build that fails passes"; exit 1; }
done
exit 0
