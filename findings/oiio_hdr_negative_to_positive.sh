#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# OpenImageIO 2.4.7.1 (Debian 12's openimageio-tools 2.4.7.1+dfsg-2), with libvips 8.14.1 beside it.
#
# Its writer of Radiance pictures (.hdr) turns a negative channel beside a positive one into a large positive one: of
# (1, -0.2, 0.5) green becomes 1.80, without a warning. RGBE has no sign, so one expects 0, which is what libvips writes.
# Negative light is common: saturated colours after a conversion to smaller primaries, differences, and filters that ring, as
# oiiotool's own resize does by default: red beside magenta gets a line of full blue that was -0.02. Only negatives of less
# than about 1/256 of the largest channel, or in pixels without a positive one, become 0. --clamp:min=0 before -o helps.
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
    install openimageio-tools=2.4.7.1+dfsg-2 libvips-tools=8.14.1-3+deb12u3 >apt.log 2>&1 || { cat apt.log; exit 1; }
for package in archives/*.deb; do dpkg-deb -x "$package" root; done
libraries=$(find "$folder/root" -name '*.so*' -printf '%h\n' | sort -u | paste -sd:)
loader=$(find "$folder/root" -name 'ld-linux-x86-64.so.2' | head -1)
program() { "$loader" --library-path "$libraries" "root/usr/bin/$1" "${@:2}"; }

# A column for each of these pixels
pixels='1,-0.2,0.5 1,-0.01,1 1,-0.002,1 1,-1,0.5 0.01,-0.002,0 -0.5,-0.2,-0.1'
columns=() x=0
for pixel in $pixels; do columns+=("--fill:color=$pixel" "1x8+$((x++))+0"); done
program oiiotool --pattern constant:color=0,0,0 8x8 3 "${columns[@]}" -d float -o in.exr
program oiiotool in.exr -o out.hdr --clamp:min=0 -o clamped.hdr
program vips copy in.exr vips.hdr

{
    program oiiotool --version
    echo "pixels: $pixels"
    for file in out vips clamped; do
        echo "green of $file.hdr:$(program oiiotool --dumpdata $file.hdr | awk '/Pixel .[0-5], 0/ { printf " %.3f", $5 }')"
    done
    # Red beside magenta, made smaller
    program oiiotool --pattern constant:color=1,0,0 64x64 3 --fill:color=1,0,1 32x64+32+0 -d float -o edge.exr
    for file in small.exr small.hdr; do
        program oiiotool edge.exr --resize 24x24 -o $file
        echo "blue of $file from left to right:$(program oiiotool --dumpdata $file |
            awk '/Pixel .(7|8|9|10|11|12), 0/ { printf " %.2f", $6 }')"
    done
} | tee seen

diff - seen <<'END'
2.4.7.1
pixels: 1,-0.2,0.5 1,-0.01,1 1,-0.002,1 1,-1,0.5 0.01,-0.002,0 -0.5,-0.2,-0.1
green of out.hdr: 1.805 1.992 0.000 1.000 0.014 0.000
green of vips.hdr: 0.000 0.000 0.000 0.000 0.000 0.000
green of clamped.hdr: 0.000 0.000 0.000 0.000 0.000 0.000
blue of small.exr from left to right: 0.00 0.00 0.00 -0.02 0.06 0.94
blue of small.hdr from left to right: 0.00 0.00 0.00 0.98 0.06 0.94
END
