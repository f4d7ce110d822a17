#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# OpenEXR 3.1.5 (exrenvmap of Debian 12's openexr 3.1.5-5).
#
# exrenvmap -b makes a diffuse environment map: by its help, the colour of a white diffuse surface with that normal, E / pi.
# In its sum, a pixel of the cube map that it works on has a weight that grows with its distance from the middle of the face,
# where its solid angle shrinks. So a small light is too dark in the middle of a face, and too bright at edges and corners:
# a light of 20 by 20 degrees at the horizon, which gives the normal towards it 3.70, comes out as 1.18 at longitude 0 and
# 4.85 at longitude 45. Turning a sky so changes its light by a factor of four. A constant sky is right within 1 %, which
# hides it. The source of OpenEXR 3.4.16 has the same weights (not run here).
#
# Needs apt-get with the archive of Debian 12 on amd64; installs nothing: unpacks the packages in a temporary folder. Takes
# up to two minutes. Exits with 1 if the results differ from these.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
mkdir -p archives/partial root
touch status # as if nothing were installed, so that all that the programs need is downloaded
apt-get -qq -y --no-install-recommends --download-only -o Debug::NoLocking=1 -o APT::Sandbox::User=root \
    -o Dir::State::status="$folder/status" -o Dir::Cache::archives="$folder/archives" \
    install openexr=3.1.5-5 openimageio-tools=2.4.7.1+dfsg-2 >apt.log 2>&1 || { cat apt.log; exit 1; }
for package in archives/*.deb; do dpkg-deb -x "$package" root; done
libraries=$(find "$folder/root" -name '*.so*' -printf '%h\n' | sort -u | paste -sd:)
loader=$(find "$folder/root" -name 'ld-linux-x86-64.so.2' | head -1)
program() { "$loader" --library-path "$libraries" "root/usr/bin/$1" "${@:2}"; }

blur() {
    program exrenvmap -li -l -b -w 128 sky.exr diffuse.exr
    program oiiotool diffuse.exr --printstats | awk '/Stats M/ { printf " %.2f", $3 }'
}

{
    # 28 of 512 pixels are 19.7 degrees.
    for longitude in 0 45; do
        program oiiotool --pattern constant:color=0,0,0 512x256 3 \
            --fill:color=100,100,100 "28x28+$((242 + 64 * longitude / 45))+114" -d half -o sky.exr
        echo "a light at longitude $longitude:$(blur | awk '{ print "", $2 }')"
    done
    awk 'BEGIN { pi = atan2(0, -1); a = 14 / 256 * pi
        printf "what it should be: %.2f\n", 100 / pi * (a + sin(2 * a) / 2) * 2 * sin(a) }'
    program oiiotool --pattern constant:color=1,1,1 512x256 3 -d half -o sky.exr
    echo "a constant sky of 1:$(blur)"
} | tee seen

diff - seen <<'END'
a light at longitude 0: 1.18
a light at longitude 45: 4.85
what it should be: 3.70
a constant sky of 1: 1.00 1.01
END
