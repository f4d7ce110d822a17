#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# OpenImageIO 2.4.7.1 (Debian 12's libopenimageio-dev 2.4.7.1+dfsg-2): TextureSystem::texture() with "<UDIM>" in the name.
#
# The tile is chosen with v up, as UDIM has it: t in [1, 2) is the row of 1011. Inside the tile t runs down, as in every
# image: t = 1.25 is a quarter below the top of 1011. So neither convention alone is right over several rows of tiles. A
# renderer that passes the UVs of a mesh gets the right tile upside down; one that passes 1 - v, as it does for a single
# image, gets the rows right in 1001 and looks for tiles below 1001 elsewhere. What works: t = floor(v) + 1 - (v - floor(v)).
#
# Needs g++, the libraries that Debian 12's libopenimageio-dev depends on, and apt-get with the archive of Debian 12 on
# amd64; installs nothing: unpacks the packages in a temporary folder. Exits with 1 if the answer is another than written here.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
for package in libopenimageio2.4=2.4.7.1+dfsg-2 libopenimageio-dev=2.4.7.1+dfsg-2; do
    apt-get -qq download -o APT::Sandbox::User=root "$package"
done
for package in ./*.deb; do dpkg-deb -x "$package" root; done
libraries=$folder/root/usr/lib/x86_64-linux-gnu

cat >rows.cpp <<'END'
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/texture.h>
#include <cstdio>
using namespace OIIO;
int main()
{
    // The rows of each tile, from the top, have the tile's number and the row behind the point.
    for (int udim : { 1001, 1011 }) {
        float rows[4 * 4];
        for (int i = 0; i < 16; ++i)
            rows[i] = float(udim + i / 4 / 10.0);
        ImageSpec spec(4, 4, 1, TypeDesc::FLOAT);
        const std::string name = "tile." + std::to_string(udim) + ".exr";
        auto out = ImageOutput::create(name);
        out->open(name, spec);
        out->write_image(TypeDesc::FLOAT, rows);
        out->close();
    }
    TextureSystem* system = TextureSystem::create(false);
    for (float t : { 0.125f, 0.875f, 1.125f, 1.875f }) {
        TextureOpt options;
        options.interpmode = TextureOpt::InterpClosest;
        options.swrap = options.twrap = TextureOpt::WrapClamp;
        float value = -1;
        system->texture(ustring("tile.<UDIM>.exr"), options, 0.5f, t, 0, 0, 0, 0, 1, &value);
        std::printf("t = %.3f: tile %d, row %d from the top\n", t, int(value), int((value - int(value)) * 10 + 0.5f));
    }
    TextureSystem::destroy(system);
}
END
g++ -std=c++17 rows.cpp -I root/usr/include -I /usr/include/Imath -L "$libraries" -lOpenImageIO -lOpenImageIO_Util -o rows
LD_LIBRARY_PATH=$libraries ./rows | tee seen

diff - seen <<'END'
t = 0.125: tile 1001, row 0 from the top
t = 0.875: tile 1001, row 3 from the top
t = 1.125: tile 1011, row 0 from the top
t = 1.875: tile 1011, row 3 from the top
END
