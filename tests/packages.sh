#!/bin/sh
# What a machine has of packages.txt.
#   packages.sh install    installs what is missing: as root, or with sudo; else prints the one command to run
#   packages.sh doctor     says of each package whether it is there
set -eu
cd "$(dirname "$0")/.."

names() { sed -e 's/#.*//' "$1" | tr -s ' \t\n' '\n' | sed '/^$/d'; }
is_installed() { [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }
missing() { for name in $(names packages.txt); do is_installed "$name" || printf '%s ' "$name"; done; }

install() {
    list=$(missing)
    [ -n "$list" ] || return 0
    command="apt-get install -y --no-install-recommends $list"
    if [ "$(id -u)" = 0 ]; then as_root=
    elif sudo -n true 2>/dev/null || { [ -t 0 ] && command -v sudo >/dev/null; }; then as_root=sudo
    else
        echo "packages are missing; as root, run: apt-get update && $command" >&2
        exit 1
    fi
    echo "installing $list"
    # A bare machine has no lists of packages yet, and an old list names files that are gone.
    $as_root env DEBIAN_FRONTEND=noninteractive sh -c "apt-get update -q && $command" >build/install.log 2>&1 ||
        { tail -n 5 build/install.log >&2; echo "packages.sh: apt-get failed; all of its output is in build/install.log" >&2; exit 1; }
}

doctor() {
    status=0
    while IFS='#' read -r name why; do
        name=$(echo "$name" | tr -d ' \t')
        [ -n "$name" ] || continue
        if is_installed "$name"; then printf '  there    %-22s%s\n' "$name" "$why"
        else printf '  MISSING  %-22s%s\n' "$name" "$why"; status=1; fi
    done <packages.txt
    printf '  cores    %s\n  display  %s\n' "$(nproc)" "${DISPLAY:-${WAYLAND_DISPLAY:-none: windows will not open, everything else works}}"
    [ $status = 0 ] || echo "make install installs what is missing"
    exit $status
}

mkdir -p build
case "${1:-}" in
install) install ;;
doctor) doctor ;;
*) echo "usage: packages.sh install | doctor" >&2; exit 2 ;;
esac
