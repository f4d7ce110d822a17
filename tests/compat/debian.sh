#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds and tests the working tree on another Debian, with other versions of the compiler and of every library. Run it by hand,
# as root, on a Debian with debootstrap. Needs about 5 GB in TMPDIR while it runs.
set -euo pipefail

usage() {
    cat <<'END'
usage: tests/compat/debian.sh [SUITE]
  SUITE   bookworm, trixie, sid, ... (default: sid), from the mirror that apt uses on this machine
KEEP=1 in the environment keeps the chroot and prints its path.
END
}

case ${1:-} in
-*)
    usage
    [[ $1 == -h || $1 == --help ]] && exit 0
    exit 2
    ;;
esac
(($# <= 1)) || { usage >&2; exit 2; }
suite=${1:-sid}
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)

fail() { echo "debian.sh: $*" >&2; exit 1; }
say() { echo "=== $suite: $* (${SECONDS} s)"; }

((EUID == 0)) || fail "must run as root: it builds in a chroot"
command -v debootstrap >/dev/null || fail "debootstrap is missing: install debootstrap"
mirror=$(apt-get indextargets --format '$(ORIGIN) $(LABEL) $(REPO_URI)' |
    awk '$1 == "Debian" && $2 == "Debian" && !found++ { print $3 }')
[[ -n $mirror ]] || fail "apt has no Debian mirror here; run apt-get update"

root=$(mktemp -d "${TMPDIR:-/tmp}/vmlight-$suite.XXXXXX")
chmod 755 "$root" # apt fetches as a user of its own
clean() {
    local folder
    for folder in proc sys; do
        if mountpoint -q "$root/$folder"; then umount "$root/$folder"; fi
    done
    if [[ ${KEEP:-} == 1 ]]; then
        echo "kept: $root"
    else
        rm -rf --one-file-system "$root"
    fi
}
trap clean EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

inside() {
    chroot "$root" env -i HOME=/root LC_ALL=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive "$@"
}

say "debootstrap"
log=$(debootstrap --variant=minbase "$suite" "$root" "$mirror" 2>&1) || { tail -n 20 <<<"$log" >&2; fail "debootstrap failed"; }
mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"
apt-config dump | grep -E '^Acquire::(https?::|Check-)' >"$root/etc/apt/apt.conf.d/90mirror" || true # as the mirror needs
echo 'Dpkg::Use-Pty "false";' >"$root/etc/apt/apt.conf.d/90pty" # there is none
echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/unsafe-io"

mkdir "$root/vmlight"
(cd "$source" && git ls-files -z --cached --others --exclude-standard |
    while IFS= read -r -d '' file; do [[ ! -e $file ]] || printf '%s\0' "$file"; done |
    tar -c --null --no-recursion -T -) | tar -x --no-same-owner -C "$root/vmlight"

# Newer compilers warn of other things: that is for reading, not for failing.
say "bootstrap.sh test"
status=0
inside /vmlight/bootstrap.sh test -DVMLIGHT_WERROR=OFF || status=$?

say "versions"
inside dpkg-query -f '${db:Status-Abbrev} ${source:Package} ${Version}\n' -W 'libopenimageio*' 'libopencolorio*' 'libembree*' \
    'libassimp*' 'libalembic*' 'libeigen3*' 'libhwy*' 'libimath*' 'libopenexr*' 'libgtest*' 'libbenchmark*' g++ cmake 2>/dev/null |
    awk '$1 == "ii" { print "  " $2, $3 }' | sort -u
inside g++ --version | head -n 1
((status == 0)) || fail "$suite failed"
say "all passed"
