#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the Debian packages in a bare Debian, and installs, uses, checks and removes them in another. Run it by hand, as root,
# on a Debian with debootstrap. Needs about 5 GB in TMPDIR while it runs.
set -euo pipefail

usage() {
    cat <<'END'
usage: tests/compat/packages.sh [SUITE] [FOLDER]
  SUITE    bookworm, trixie, sid, ... (default: bookworm), from the mirror that apt uses on this machine
  FOLDER   of packages for SUITE that exist already: makes none
TWICE=1 in the environment makes them twice, in different surroundings, and compares the bytes.
KEEP=1 keeps the chroots and prints their paths; CCACHE=FOLDER shares results of compiling between runs.
END
}

# shellcheck source=tests/compat/chroot.sh
source "$(dirname "${BASH_SOURCE[0]}")/chroot.sh"
check_arguments 2 "$@"
suite=${1:-bookworm}

# step WHAT COMMAND...: what the command prints is shown where it fails.
step() {
    local what=$1 log
    shift
    log=$("$@" 2>&1) || { tail -n 40 <<<"$log" >&2; fail "$suite: failed: $what"; }
    say "$what"
}

if [[ -n ${2:-} ]]; then
    packages=$(cd "$2" && pwd)
else
    say "debootstrap, to build"
    make_chroot
    date=$(git -C "$source" log -1 --format=%ct)
    copy_tree /vmlight
    again=/home/some/where/else/vmlight
    if [[ ${TWICE:-} == 1 ]]; then # now: who works on the tree meanwhile changes neither
        mkdir -p "$root${again%/*}"
        cp -a "$root/vmlight" "$root$again"
    fi
    step "bootstrap.sh package" inside SOURCE_DATE_EPOCH="$date" /vmlight/bootstrap.sh package
    packages=$root/vmlight/build/package/packages
    if [[ ${TWICE:-} == 1 ]]; then
        step "the same in another folder, with another umask, time zone and language" inside SOURCE_DATE_EPOCH="$date" \
            TZ=Asia/Kolkata LC_ALL=C LANG=C bash -c "umask 077; $again/bootstrap.sh package"
        for package in "$packages"/*.deb; do
            step "same bytes: ${package##*/}" cmp "$package" "$root$again/build/package/packages/${package##*/}"
        done
    fi
fi

say "debootstrap, to use"
make_chroot
mkdir "$root/packages" "$root/consumer"
cp "$packages"/*.deb "$root/packages"
cp "$source"/tests/consumer/{CMakeLists.txt,consumer.cpp} "$root/consumer"
inside useradd -m artist
cp "$source"/tests/data/{spot.obj,studio_small_03.hdr} "$root/home/artist"
names=() files=()
for package in "$root"/packages/*.deb; do
    names+=("$(dpkg-deb -f "$package" Package)")
    files+=("/packages/${package##*/}")
done
for name in vmlight libvmlight0 libvmlight-dev python3-vmlight vmlight-doc; do
    [[ " ${names[*]} " == *" $name "* ]] || fail "$suite: there is no package $name"
done
(cd "$root/packages" && stat --printf '  %s %n\n' ./*.deb)

step "apt-get update" inside apt-get -qq update
step "apt-get install lintian" apt_install lintian
inside lintian --fail-on error,warning --tag-display-limit 0 "${files[@]}" || fail "$suite: lintian finds faults"
say "lintian"
step "apt-get install" apt_install "${files[@]}"
inside dpkg -L "${names[@]}" | grep . | sort -u >"$root/packages/paths"
step "programs that a user has" apt_install openimageio-tools man-db bash-completion zsh cmake g++ make python3

as_artist() {
    chroot --userspec=artist:artist "$root" env -i HOME=/home/artist LC_ALL=C.UTF-8 PATH=/usr/bin:/bin bash -euc "cd; $1"
}
readers="export OIIO_LIBRARY_PATH=\$(sed -n 's/.*export OIIO_LIBRARY_PATH=//p' /usr/share/doc/vmlight/README.Debian)"
step "makevismap" as_artist "makevismap spot.obj --resolution 64 --samples 64 -o spot_vismap.exr --quiet"
step "makecfem" as_artist "makecfem studio_small_03.hdr --stack -o studio_cfem.exr --quiet"
step "makelightmap" as_artist "makelightmap spot_vismap.exr studio_cfem.exr -o spot_lit.exr --quiet"
step "a recipe" as_artist "makevismap spot.obj --resolution 64 --samples 64 -o spot.vismap"
step "oiiotool reads the recipe, the same pixels" as_artist \
    "$readers; oiiotool spot.vismap spot_vismap.exr --fail 0 --diff && oiiotool spot.vismap -o copy.exr"
step "an OCIO config" as_artist "OCIO=/usr/share/vmlight/ocio/config.ocio makecfem studio_small_03.hdr -o studio_acescg.exr --quiet"
for program in $(grep '^/usr/bin/.' "$root/packages/paths" | xargs -n 1 basename); do
    step "$program: runs, has a man page and completions" as_artist "
        $program --version
        man $program | grep -q '^NAME'
        . /usr/share/bash-completion/bash_completion
        if declare -F _comp_load >/dev/null; then _comp_load $program; else _completion_loader $program || ((\$? == 124)); fi
        complete -p $program | grep -q 'F _$program'
        COMP_WORDS=($program --vers) COMP_CWORD=1; _$program; [[ \${COMPREPLY[0]} == --version* ]]
        zsh -c 'autoload -U compinit; compinit -D; [[ \$_comps[$program] == _$program ]] && autoload +X _$program'"
done
step "import vmlight" as_artist "python3 -c '
import vmlight
vmlight.make_lightmap(\"spot_vismap.exr\", \"studio_cfem.exr\").write(\"spot_lit_python.exr\")'
    cmp spot_lit.exr spot_lit_python.exr"
step "find_package(vmlight)" as_artist "cmake -S /consumer -B consumer && cmake --build consumer -j 2 && consumer/consumer"
step "the program runs by libvmlight.so.0" as_artist "ldd consumer/consumer | grep -q libvmlight.so.0"
step "the manual" as_artist "test -s /usr/share/doc/vmlight/docs/pipeline.md -a -s /usr/share/doc/vmlight/docs/view.png"
step "what is installed is what was packed" inside dpkg --verify "${names[@]}"

step "apt-get remove" inside apt-get -qq remove -y "${names[@]}"
step "dpkg --purge" inside dpkg --purge "${names[@]}"
left=$(while IFS= read -r path; do
    [[ ! -e $root$path ]] || inside dpkg -S "$path" >/dev/null 2>&1 || echo "$path"
done <"$root/packages/paths"
    cd "$root" && find etc usr var -path var/log -prune -o \( -iname '*vmlight*' -o -iname '*vismap*' -o -iname '*cfem*' \) -print)
[[ -z $left ]] || fail "$suite: left behind: $left"
if inside ldconfig -p | grep -q vmlight; then fail "$suite: the linker's cache still has libvmlight"; fi
say "all passed"
