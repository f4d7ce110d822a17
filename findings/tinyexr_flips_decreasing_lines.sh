#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tinyexr 1.0.1 (Debian 12's libtinyexr1d and libtinyexr-dev 1.0.1+dfsg-4).
#
# The lineOrder of an OpenEXR file says in which order its lines lie in the file, no more: line 0 is the top one either way.
# tinyexr turns pictures with decreasing lines upside down, without a warning, whatever the compression. Programs that
# embed it show such an HDRI with the ground above, and a texture flipped; OpenImageIO, FFmpeg and libvips read both alike.
# Fixed in tinyexr's repository in 2025.
#
# Needs g++, and apt-get with the archive of Debian 12 on amd64; installs nothing: unpacks the packages in a temporary
# folder. Exits with 1 if the results differ from these.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
mkdir -p archives/partial root
touch status # as if nothing were installed, so that all that the programs need is downloaded
apt-get -qq -y --no-install-recommends --download-only -o Debug::NoLocking=1 -o APT::Sandbox::User=root \
    -o Dir::State::status="$folder/status" -o Dir::Cache::archives="$folder/archives" \
    install openimageio-tools=2.4.7.1+dfsg-2 ffmpeg=7:5.1.9-0+deb12u1 libvips-tools=8.14.1-3+deb12u3 \
        libtinyexr1d=1.0.1+dfsg-4 libtinyexr-dev=1.0.1+dfsg-4 >apt.log 2>&1 || { cat apt.log; exit 1; }
for package in archives/*.deb; do dpkg-deb -x "$package" root; done
libraries=$(find "$folder/root" -name '*.so*' -printf '%h\n' | sort -u | paste -sd:)
loader=$(find "$folder/root" -name 'ld-linux-x86-64.so.2' | head -1)
program() { "$loader" --library-path "$libraries" "root/usr/bin/$1" "${@:2}"; }

cat >rows.cpp <<'CPP'
#include <tinyexr.h>
#include <cstdio>
#include <cstdlib>
int main(int, char** argv)
{
    float* pixels;
    int width, height;
    const char* error = nullptr;
    if (LoadEXR(&pixels, &width, &height, argv[1], &error) != TINYEXR_SUCCESS)
        return 1;
    std::printf("%.2f %.2f", pixels[0], pixels[4 * width * (height - 1)]);
    std::free(pixels);
}
CPP
g++ -std=c++17 rows.cpp -I root/usr/include root/usr/lib/x86_64-linux-gnu/libtinyexr.so.1d -Wl,--allow-shlib-undefined \
    -o root/usr/bin/rows

# The top row is 1, the bottom row .25.
{
    for compression in none zips zip piz; do
        for order in increasingY decreasingY; do
            program oiiotool --pattern fill:top=1,1,1:bottom=0.25,0.25,0.25 64x64 3 -d half \
                --attrib openexr:lineOrder $order --compression $compression -o in.exr
            program ffmpeg -v error -y -i in.exr -f rawvideo -pix_fmt gbrpf32le out.raw
            echo "$compression, $order: tinyexr $(program rows in.exr)," \
                "OpenImageIO $(program oiiotool --dumpdata in.exr | awk '/Pixel .0, 0/ { printf "%.2f", $4 }')," \
                "FFmpeg $(od -A n -t f4 -N 4 out.raw | awk '{ printf "%.2f", $1 }')," \
                "libvips $(program vips getpoint in.exr 0 0 | awk '{ printf "%.2f", $1 }')"
        done
    done
} | tee seen

diff - seen <<'END'
none, increasingY: tinyexr 1.00 0.25, OpenImageIO 1.00, FFmpeg 1.00, libvips 1.00
none, decreasingY: tinyexr 0.25 1.00, OpenImageIO 1.00, FFmpeg 1.00, libvips 1.00
zips, increasingY: tinyexr 1.00 0.25, OpenImageIO 1.00, FFmpeg 1.00, libvips 1.00
zips, decreasingY: tinyexr 0.25 1.00, OpenImageIO 1.00, FFmpeg 1.00, libvips 1.00
zip, increasingY: tinyexr 1.00 0.25, OpenImageIO 1.00, FFmpeg 1.00, libvips 1.00
zip, decreasingY: tinyexr 0.25 1.00, OpenImageIO 1.00, FFmpeg 1.00, libvips 1.00
piz, increasingY: tinyexr 1.00 0.25, OpenImageIO 1.00, FFmpeg 1.00, libvips 1.00
piz, decreasingY: tinyexr 0.25 1.00, OpenImageIO 1.00, FFmpeg 1.00, libvips 1.00
END
