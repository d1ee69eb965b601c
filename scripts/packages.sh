# shellcheck shell=bash disable=SC2154
# Sourced by scripts/demo and scripts/test: options that both take, and packages they need.

# usage <script> <what it does>
usage() {
    cat <<TXT
usage: scripts/$1 [--yes] [--no-install]
$2
  --yes         install missing packages without asking (also: as root, or with CI=true)
  --no-install  install nothing, build with what is there
TXT
}

install=ask
parse_options() {
    local script=$1 what=$2
    shift 2
    if [ "$(id -u)" = 0 ] || [ "${CI:-}" = true ]; then
        install=yes
    fi
    local argument
    for argument in "$@"; do
        case $argument in
            --yes) [ "$install" = no ] || install=yes ;;
            --no-install) install=no ;;
            --help | -h) usage "$script" "$what"; exit 0 ;;
            *) usage "$script" "$what" >&2; exit 2 ;;
        esac
    done
}

# packages_of <group...>: the packages of scripts/packages.debian in these groups
packages_of() {
    awk -v wanted=" $* " '
        {sub(/#.*/, ""); gsub(/[ \t]/, "")}
        /^\[.*\]$/ {on = index(wanted, " " substr($0, 2, length($0) - 2) " "); next}
        $0 != "" && on' "$root/scripts/packages.debian"
}

# missing_packages <group...>
missing_packages() {
    local package
    for package in $(packages_of "$@"); do
        # A package can be listed and yet removed; only "installed" counts.
        [ "$(dpkg-query -W -f '${db:Status-Status}\n' "$package" 2>/dev/null | head -n 1)" = installed ] ||
            echo "$package"
    done
}

# What each group must put on the PATH, for systems whose packages we cannot ask about.
commands_of() {
    local group
    for group in "$@"; do
        case $group in
            build) echo cmake ninja c++ ;;
            test) echo nm readelf pkg-config clang-format ;;
        esac
    done
}

# ensure_packages <group...>: returns when everything is there (or --no-install was given)
ensure_packages() {
    [ "$install" != no ] || return 0
    if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
        local tool lacking=()
        # shellcheck disable=SC2046
        for tool in $(commands_of "$@"); do
            command -v "$tool" >/dev/null || lacking+=("$tool")
        done
        {
            echo "This system has no apt, so nothing was installed."
            [ ${#lacking[@]} = 0 ] || echo "Missing commands: ${lacking[*]}"
            echo "Needed, by their Debian names: $(packages_of "$@" | tr '\n' ' ')"
            echo "Install what corresponds to them, then run this again with --no-install."
        } >&2
        exit 1
    fi
    local missing
    missing=$(missing_packages "$@" | tr '\n' ' ')
    [ -n "$missing" ] || return 0
    echo "Missing packages: $missing"
    case $missing in
        *:*) echo "Those with a colon need dpkg --add-architecture, which is part of it." ;;
    esac
    local sudo=()
    if [ "$(id -u)" != 0 ]; then
        if ! command -v sudo >/dev/null; then
            echo "There is no sudo. As root, run: apt-get install $missing" >&2
            exit 1
        fi
        sudo=(sudo)
    fi
    if [ "$install" = ask ]; then
        if [ ! -t 0 ]; then
            echo "Nobody to ask. Run again with --yes, or run: sudo apt-get install $missing" >&2
            exit 1
        fi
        local answer
        read -r -p "Install them with sudo apt-get? [y/N] " answer
        case $answer in
            [yY]*) ;;
            *) echo "Nothing installed. --no-install builds with what is there." >&2; exit 1 ;;
        esac
    fi
    local apt=("${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -y -q --no-install-recommends)
    local foreign
    foreign=$(tr ' ' '\n' <<<"$missing" | sed -n 's/.*://p' | sort -u)
    local architecture added=no
    for architecture in $foreign; do
        if ! dpkg --print-foreign-architectures | grep -qx "$architecture"; then
            "${sudo[@]}" dpkg --add-architecture "$architecture"
            added=yes
        fi
    done
    [ "$added" = no ] || "${apt[@]}" update
    # The lists may be absent or too old for what they point to: refresh them only then.
    # shellcheck disable=SC2086
    if ! "${apt[@]}" install $missing; then
        "${apt[@]}" update
        "${apt[@]}" install $missing
    fi
}

# configure_and_build <preset> [target...]: configures only if that was never done, or if the last
# attempt failed; Ninja does it again by itself when a CMakeLists.txt changed.
configure_and_build() {
    local preset=$1
    shift
    if [ ! -e "$root/build/$preset/build.ninja" ]; then
        cmake --preset "$preset" -S "$root"
    fi
    cmake --build "$root/build/$preset" ${@:+--target "$@"}
}
