#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# FFmpeg 5.1.9 (Debian 12's ffmpeg 7:5.1.9-0+deb12u1).
#
# Its EXR decoder returns the square of every 32-bit float channel that is compressed with DWAA or DWAB (the sign is
# kept), without a warning: 0.5 becomes 0.25, 2 becomes 4. The same picture as half floats, or with any other
# compression, is read as it is. OpenImageIO reads all of them alike.
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
    install ffmpeg=7:5.1.9-0+deb12u1 openimageio-tools=2.4.7.1+dfsg-2 >apt.log 2>&1 || { cat apt.log; exit 1; }
for package in archives/*.deb; do dpkg-deb -x "$package" root; done
libraries=$(find "$folder/root" -name '*.so*' -printf '%h\n' | sort -u | paste -sd:)
loader=$(find "$folder/root" -name 'ld-linux-x86-64.so.2' | head -1)
program() { "$loader" --library-path "$libraries" "root/usr/bin/$1" "${@:2}"; }

{
    program ffmpeg -version | grep -o '^ffmpeg version [0-9.]*'
    for type in float half; do
        for compression in zip dwaa dwab; do
            for value in 0.5 2 -0.5; do
                program oiiotool --pattern "constant:color=$value,$value,$value" 32x32 3 -d $type \
                    --compression $compression -o flat.exr
                program ffmpeg -v error -y -i flat.exr -f rawvideo -pix_fmt gbrpf32le flat.raw
                printf '%s %s %s: %.2f\n' $type $compression $value "$(od -A n -t f4 -N 4 flat.raw)"
            done
        done
    done
} | tee seen

diff - seen <<'END'
ffmpeg version 5.1.9
float zip 0.5: 0.50
float zip 2: 2.00
float zip -0.5: -0.50
float dwaa 0.5: 0.25
float dwaa 2: 4.01
float dwaa -0.5: -0.25
float dwab 0.5: 0.25
float dwab 2: 4.01
float dwab -0.5: -0.25
half zip 0.5: 0.50
half zip 2: 2.00
half zip -0.5: -0.50
half dwaa 0.5: 0.50
half dwaa 2: 2.00
half dwaa -0.5: -0.50
half dwab 0.5: 0.50
half dwab 2: 2.00
half dwab -0.5: -0.50
END
