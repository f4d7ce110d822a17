#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# FFmpeg 5.1.9 and OpenColorIO 2.1.2 (Debian 12's ffmpeg 7:5.1.9-0+deb12u1, opencolorio-tools 2.1.2+dfsg1-4+b3).
#
# DOMAIN_MIN and DOMAIN_MAX of a .cube file say which inputs its table spans. FFmpeg's filters lut1d and lut3d ignore
# where the domain starts, and take one that is narrower than 1 for 1 wide; only domains that start at 0 and are at
# least 1 wide come out right. There is no warning. A LUT for a log or camera space, or for signed data, as baked with
# such a domain, gives other colours in a dailies or review file than in a program that uses OpenColorIO, which heeds
# the domain. Here LUTs that return what they are given make -0.5, 0.375 and 0.625 of 0.5.
#
# Needs apt-get with the archive of Debian 12 on amd64; installs nothing: unpacks the packages in a temporary folder.
# Exits with 1 if the results differ from these.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
mkdir -p archives/partial root
touch status # as if nothing were installed, so that all that the programs need is downloaded
apt-get -qq -y --no-install-recommends --download-only -o Debug::NoLocking=1 -o APT::Sandbox::User=root \
    -o Dir::State::status="$folder/status" -o Dir::Cache::archives="$folder/archives" \
    install ffmpeg=7:5.1.9-0+deb12u1 opencolorio-tools=2.1.2+dfsg1-4+b3 >apt.log 2>&1 || { cat apt.log; exit 1; }
for package in archives/*.deb; do dpkg-deb -x "$package" root; done
libraries=$(find "$folder/root" -name '*.so*' -printf '%h\n' | sort -u | paste -sd:)
loader=$(find "$folder/root" -name 'ld-linux-x86-64.so.2' | head -1)
program() { "$loader" --library-path "$libraries" "root/usr/bin/$1" "${@:2}"; }

# A LUT with two entries for each axis, each its own input: it changes nothing from $2 to $3.
lut() {
    echo "LUT_$1_SIZE 2"
    echo "DOMAIN_MIN $2 $2 $2"
    echo "DOMAIN_MAX $3 $3 $3"
    if [ "$1" = 1D ]; then
        printf '%s %s %s\n' "$2" "$2" "$2" "$3" "$3" "$3"
    else
        for b in "$2" "$3"; do for g in "$2" "$3"; do for r in "$2" "$3"; do echo "$r $g $b"; done; done; done
    fi
}

for _ in $(seq 768); do printf '\0\0\0\x3f'; done >half.raw # 16x16 pixels of 0.5
{
    program ffmpeg -version | grep -o '^ffmpeg version [0-9.]*'
    for kind in 1D 3D; do
        for domain in '0 1' '0 4' '0 0.75' '0.25 1' '-1 1'; do
            # shellcheck disable=SC2086
            lut $kind $domain >lut.cube
            program ffmpeg -v error -y -f rawvideo -pix_fmt gbrpf32le -s 16x16 -i half.raw \
                -vf "lut${kind,,}=file=lut.cube" -f rawvideo -pix_fmt gbrpf32le out.raw
            printf '%s, domain %s: FFmpeg %.3f, OpenColorIO %.3f\n' $kind "$domain" \
                "$(od -A n -t f4 -N 4 out.raw)" "$(program ociochecklut lut.cube 0.5 0.5 0.5 | awk '{ print $1 }')"
        done
    done
} | tee seen

diff - seen <<'END'
ffmpeg version 5.1.9
1D, domain 0 1: FFmpeg 0.500, OpenColorIO 0.500
1D, domain 0 4: FFmpeg 0.500, OpenColorIO 0.500
1D, domain 0 0.75: FFmpeg 0.375, OpenColorIO 0.500
1D, domain 0.25 1: FFmpeg 0.625, OpenColorIO 0.500
1D, domain -1 1: FFmpeg -0.500, OpenColorIO 0.500
3D, domain 0 1: FFmpeg 0.500, OpenColorIO 0.500
3D, domain 0 4: FFmpeg 0.500, OpenColorIO 0.500
3D, domain 0 0.75: FFmpeg 0.375, OpenColorIO 0.500
3D, domain 0.25 1: FFmpeg 0.625, OpenColorIO 0.500
3D, domain -1 1: FFmpeg -0.500, OpenColorIO 0.500
END
