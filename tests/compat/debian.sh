#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds and tests the working tree on another Debian, with other versions of the compiler and of every library. Run it by hand,
# as root, on a Debian with debootstrap. Needs about 5 GB in TMPDIR while it runs.
set -euo pipefail

usage() {
    cat <<'END'
usage: tests/compat/debian.sh [SUITE]
  SUITE   bookworm, trixie, sid, ... (default: sid), from the mirror that apt uses on this machine
KEEP=1 in the environment keeps the chroot and prints its path; CCACHE=FOLDER shares results of compiling between runs.
END
}

# shellcheck source=tests/compat/chroot.sh
source "$(dirname "${BASH_SOURCE[0]}")/chroot.sh"
check_arguments 1 "$@"
suite=${1:-sid}

say "debootstrap"
make_chroot
copy_tree /vmlight

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
