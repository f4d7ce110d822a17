# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash disable=SC2016,SC2054
# For scripts that work in a bare Debian: source it, check_arguments, then set `suite`. Needs root, debootstrap, and apt's
# Debian mirror.
# KEEP=1 in the environment keeps the chroots and prints their paths. CCACHE=FOLDER shares results of compiling between runs.

fail() { echo "$(basename "$0"): $*" >&2; exit 1; }

# check_arguments MOST "$@": answers --help by the script's usage(), and refuses flags and more than MOST arguments.
check_arguments() {
    case ${2:-} in
    -h | --help) usage; exit 0 ;;
    -*) usage >&2; exit 2 ;;
    esac
    (($# <= $1 + 1)) || { usage >&2; exit 2; }
}

say() { echo "=== $suite: $* (${SECONDS} s)"; }

source=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
chroots=()

clean_chroots() {
    local root mounted
    for root in "${chroots[@]}"; do
        for mounted in dev/pts proc ccache .; do
            if mountpoint -q "$root/$mounted"; then umount "$root/$mounted"; fi
        done
        if [[ ${KEEP:-} == 1 ]]; then
            echo "kept: $root"
        else
            rm -rf --one-file-system "$root"
        fi
    done
}
trap clean_chroots EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

# Makes a bare Debian of `suite`, and sets `root` to its folder.
make_chroot() {
    local mirror log
    ((EUID == 0)) || fail "must run as root: it works in a chroot"
    command -v debootstrap >/dev/null || fail "debootstrap is missing: install debootstrap"
    mirror=$(apt-get indextargets --format '$(ORIGIN) $(LABEL) $(REPO_URI)' |
        awk '$1 == "Debian" && $2 == "Debian" && !found++ { print $3 }')
    [[ -n $mirror ]] || fail "apt has no Debian mirror here; run apt-get update"

    root=$(mktemp -d "${TMPDIR:-/tmp}/vmlight-$suite.XXXXXX")
    chroots+=("$root")
    chmod 755 "$root" # apt fetches as a user of its own
    log=$(debootstrap --variant=minbase "$suite" "$root" "$mirror" 2>&1) ||
        { tail -n 20 <<<"$log" >&2; fail "debootstrap failed"; }
    mount --bind "$root" "$root" # tests mount file systems below it in a namespace of their own
    mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"
    mount -t devpts -o newinstance,ptmxmode=0666 devpts "$root/dev/pts"
    apt-config dump | grep -E '^Acquire::(https?::|Check-)' >"$root/etc/apt/apt.conf.d/90mirror" || true # as the mirror needs
    echo 'Dpkg::Use-Pty "false";' >"$root/etc/apt/apt.conf.d/90pty" # there is none
    echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/unsafe-io"
    if [[ -n ${CCACHE:-} ]]; then
        mkdir -p "$CCACHE" "$root/ccache"
        mount --bind "$CCACHE" "$root/ccache"
        inside apt-get -qq update
        apt_install ccache
    fi
}

inside() {
    local cache=()
    [[ -z ${CCACHE:-} ]] || cache=(CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_DIR=/ccache CCACHE_SLOPPINESS=pch_defines,time_macros)
    chroot "$root" env -i HOME=/root LC_ALL=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive "${cache[@]}" "$@"
}

apt_install() { inside apt-get -qq install -y --no-install-recommends "$@" >/dev/null; }

# Copies the working tree to FOLDER of the chroot.
copy_tree() {
    mkdir -p "$root$1"
    (cd "$source" && git ls-files -z --cached --others --exclude-standard |
        while IFS= read -r -d '' file; do [[ ! -e $file ]] || printf '%s\0' "$file"; done |
        tar -c --null --no-recursion -T -) | tar -x --no-same-owner -C "$root$1"
}
