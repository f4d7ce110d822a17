#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# OpenImageIO 2.4.7.1, FFmpeg 5.1.9, libvips 8.14.1, Netpbm 11.01, pfstools 2.2.0 (Debian 12's packages).
#
# PFM, a usual exchange format for float pictures (light probes, denoisers, stereo), has a scale factor in its third line,
# and its rows. Descriptions of the format differ in what both mean, and so do programs: of one file whose first stored row
# is .25, whose last is 1, and whose factor is 2, OpenImageIO and pfstools multiply by 2, FFmpeg and Netpbm divide, and
# libvips leaves the values: the brightest row is 2, .5 or 1. For OpenImageIO, Netpbm and pfstools the first stored row is
# the bottom one; for FFmpeg and libvips it is the top one, so that they turn pictures of the others upside down. None
# warns. A factor of 1, which says nothing but the order of bytes, is safe; no order of rows is.
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
    install openimageio-tools=2.4.7.1+dfsg-2 ffmpeg=7:5.1.9-0+deb12u1 \
        libvips-tools=8.14.1-3+deb12u3 netpbm=2:11.01.00-2 pfstools=2.2.0-5+b1 >apt.log 2>&1 || { cat apt.log; exit 1; }
for package in archives/*.deb; do dpkg-deb -x "$package" root; done
libraries=$(find "$folder/root" -name '*.so*' -printf '%h\n' | sort -u | paste -sd:)
loader=$(find "$folder/root" -name 'ld-linux-x86-64.so.2' | head -1)
program() { "$loader" --library-path "$libraries" "root/usr/bin/$1" "${@:2}"; }

# Four rows of four grey pixels: .25, .5, .75, 1, in the order of the file. Little-endian, as the sign says.
for scale in 1 2 0.5; do
    {
        printf 'PF\n4 4\n-%s\n' $scale
        for value in '\0\0\x80\x3e' '\0\0\0\x3f' '\0\0\x40\x3f' '\0\0\x80\x3f'; do
            for _ in $(seq 12); do printf "$value"; done
        done
    } >scale$scale.pfm
done

float() { od -A n -t f4 -j "$2" -N 4 "$1" | awk '{ printf "%.2f", $1 }'; }
exr_rows() { program oiiotool --dumpdata "$1" | awk '/Pixel .0, (0|3)/ { printf "%s%.2f", sep, $4; sep = " " }'; }
{
    for scale in 1 2 0.5; do
        in=scale$scale.pfm
        echo "factor $scale, OpenImageIO: $(exr_rows $in)"
        program pfsinpfm $in | program pfsoutexr out.exr
        echo "factor $scale, pfstools: $(exr_rows out.exr)"
        program ffmpeg -v error -y -i $in -f rawvideo -pix_fmt gbrpf32le out.raw
        echo "factor $scale, FFmpeg: $(float out.raw 0) $(float out.raw 48)"
        echo "factor $scale, libvips: $(for y in 0 3; do program vips getpoint $in 0 $y; done |
            awk '{ printf "%.2f ", $1 }')"
    done
    # As integers up to 255, for which a factor below 1 would be too bright.
    for scale in 1 2; do
        program pfmtopam -maxval 255 scale$scale.pfm | tail -c 48 >out.bytes
        echo "factor $scale, Netpbm: $(od -A n -t u1 -w12 out.bytes | awk 'NR % 3 == 1 { printf "%.2f ", $1 / 255 }')"
    done
} | sed 's/ $//' | tee seen

# The top row and the bottom row
diff - seen <<'END'
factor 1, OpenImageIO: 1.00 0.25
factor 1, pfstools: 1.00 0.25
factor 1, FFmpeg: 0.25 1.00
factor 1, libvips: 0.25 1.00
factor 2, OpenImageIO: 2.00 0.50
factor 2, pfstools: 2.00 0.50
factor 2, FFmpeg: 0.12 0.50
factor 2, libvips: 0.25 1.00
factor 0.5, OpenImageIO: 0.50 0.12
factor 0.5, pfstools: 0.50 0.12
factor 0.5, FFmpeg: 0.50 2.00
factor 0.5, libvips: 0.25 1.00
factor 1, Netpbm: 1.00 0.25
factor 2, Netpbm: 0.50 0.13
END
