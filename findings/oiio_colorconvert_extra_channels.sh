#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# OpenImageIO 2.4.7.1 (Debian 12's openimageio-tools 2.4.7.1+dfsg-2).
#
# Colour conversions (oiiotool --colorconvert, --tocolorspace, ImageBufAlgo::colorconvert, ...) convert the first four
# channels. The manual says that further channels are copied unaltered. They become 10 x + 0.5: data that travels with
# a picture (depth, normals, masks) is destroyed, without a warning. The source still reads so in 3.1.9 and in the main
# branch of August 2026 (not run here).
#
# Needs apt-get with the archive of Debian 12 on amd64; installs nothing: unpacks the packages in a temporary folder.
# Exits with 1 if the results differ from these.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
mkdir -p archives/partial root
touch status # as if nothing were installed, so that all that the program needs is downloaded
apt-get -qq -y --no-install-recommends --download-only -o Debug::NoLocking=1 -o APT::Sandbox::User=root \
    -o Dir::State::status="$folder/status" -o Dir::Cache::archives="$folder/archives" \
    install openimageio-tools=2.4.7.1+dfsg-2 >apt.log 2>&1 || { cat apt.log; exit 1; }
for package in archives/*.deb; do dpkg-deb -x "$package" root; done
libraries=$(find "$folder/root" -name '*.so*' -printf '%h\n' | sort -u | paste -sd:)
loader=$(find "$folder/root" -name 'ld-linux-x86-64.so.2' | head -1)
oiiotool() { "$loader" --library-path "$libraries" root/usr/bin/oiiotool "$@"; }

cat >config.ocio <<'END'
ocio_profile_version: 2
roles: {default: a, scene_linear: a}
file_rules: [!<Rule> {name: Default, colorspace: a}]
displays: {d: [!<View> {name: v, colorspace: a}]}
colorspaces:
  - !<ColorSpace> {name: a}
  - !<ColorSpace> {name: b, to_scene_reference: !<MatrixTransform> {matrix: [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1]}}
END
oiiotool --pattern constant:color=0.5,0.5,0.5,1,0.25,-0.5,0 2x2 7 --chnames R,G,B,A,d.x,d.y,d.z -d float -o in.exr
oiiotool --colorconfig config.ocio in.exr --colorconvert b a -o out.exr
{
    oiiotool --version
    oiiotool --dumpdata in.exr | grep 'Pixel (0, 0)'
    oiiotool --dumpdata out.exr | grep 'Pixel (0, 0)'
} | tee seen

# R, G, B are doubled, A is kept, and d.x, d.y and d.z should be.
diff - seen <<'END'
2.4.7.1
    Pixel (0, 0): 0.500000000 0.500000000 0.500000000 1.000000000 0.250000000 -0.500000000 0.000000000
    Pixel (0, 0): 1.000000000 1.000000000 1.000000000 1.000000000 3.000000000 -4.500000000 0.500000000
END
