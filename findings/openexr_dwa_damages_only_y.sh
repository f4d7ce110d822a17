#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# OpenEXR 3.1.5 (Debian 12's libopenexr-3-1-30 3.1.5-5, through its openimageio-tools 2.4.7.1+dfsg-2).
#
# With DWAA and DWAB, the name of a channel decides whether it is stored with a loss: R, G, B, Y, RY and BY are, in upper
# case only, alone or after a layer's dot. Of a position or normal that a renderer names P.X, P.Y, P.Z, just Y is lossy.
# The loss is not only noise: floats become halves, so of a ramp up to 100,000, what is above 65,504 becomes about 65,000
# or infinite. X and Z stay exact, so that a look at one channel finds nothing. P.x, P.y, P.z are all exact.
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
    install libopenexr-3-1-30=3.1.5-5 openimageio-tools=2.4.7.1+dfsg-2 >apt.log 2>&1 || { cat apt.log; exit 1; }
for package in archives/*.deb; do dpkg-deb -x "$package" root; done
libraries=$(find "$folder/root" -name '*.so*' -printf '%h\n' | sort -u | paste -sd:)
loader=$(find "$folder/root" -name 'ld-linux-x86-64.so.2' | head -1)
program() { "$loader" --library-path "$libraries" "root/usr/bin/$1" "${@:2}"; }

# What becomes of a ramp from 0 to $2 in the three channels $1, as floats, with the compressions in $3.
store() {
    program oiiotool --pattern "fill:top=0,0,0:bottom=$2,$2,$2" 64x64 3 --chnames "$1" -d float \
        --compression none -o exact.exr
    for compression in $3; do
        program oiiotool exact.exr -d float --compression "$compression" -o stored.exr
        program oiiotool stored.exr exact.exr --sub --abs --printstats >stats
        awk -v what="$1 up to $2, $compression" '/Stats Max/ { off = sprintf("%.4g %.4g %.4g", $3, $4, $5) }
            /InfCount/ { print what ": off by " off ", infinite: " $3, $4, $5 }' stats
    done
}
{
    for names in P.X,P.Y,P.Z P.x,P.y,P.z c.B,c.G,c.R c.b,c.g,c.r c.BY,c.RY,c.V; do store $names 1000 dwaa; done
    store P.X,P.Y,P.Z 100000 'zip dwaa dwab'
} | tee seen

diff - seen <<'END'
P.X,P.Y,P.Z up to 1000, dwaa: off by 0 3.397 0, infinite: 0 0 0
P.x,P.y,P.z up to 1000, dwaa: off by 0 0 0, infinite: 0 0 0
c.B,c.G,c.R up to 1000, dwaa: off by 3.397 3.397 3.397, infinite: 0 0 0
c.b,c.g,c.r up to 1000, dwaa: off by 0 0 0, infinite: 0 0 0
c.BY,c.RY,c.V up to 1000, dwaa: off by 3.397 3.397 0, infinite: 0 0 0
P.X,P.Y,P.Z up to 100000, zip: off by 0 0 0, infinite: 0 0 0
P.X,P.Y,P.Z up to 100000, dwaa: off by 0 3.475e+04 0, infinite: 0 128 0
P.X,P.Y,P.Z up to 100000, dwab: off by 0 3.475e+04 0, infinite: 0 128 0
END
