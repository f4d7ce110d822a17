// SPDX-License-Identifier: Apache-2.0
/// A floor and a wall that light each other, for bounced light on the command line.
#pragma once

#include "command_test.h"

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight {

class BounceTest : public CommandTest
{
protected:
    /// A floor and a wall as long as 20 of their heights, each over one half of the map; a sky of 1, and albedos.
    BounceTest()
    {
        write("corner.obj",
              "v 0 0 10\nv 1 0 10\nv 1 0 -10\nv 0 0 -10\nv 0 1 10\nv 0 1 -10\n"
              "vt 0 0\nvt 0.5 0\nvt 0.5 1\nvt 0 1\nvt 1 0\nvt 1 1\nvn 0 1 0\nvn 1 0 0\n"
              "f 1/1/1 2/2/1 3/3/1 4/4/1\nf 1/2/2 4/3/2 6/6/2 5/5/2\n");
        write("floor.obj",
              "v 0 0 10\nv 1 0 10\nv 1 0 -10\nv 0 0 -10\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 1 0\n"
              "f 1/1/1 2/2/1 3/3/1 4/4/1\n");
        write("wall.obj", "v 0 0 10\nv 0 0 -10\nv 0 1 -10\nv 0 1 10\nf 1 2 3 4\n");
        write("corner.vismap", "mesh = \"corner.obj\"\nresolution = 64\nsamples = 256\nmargin = 2\n");
        write("shaded.vismap", "mesh = \"floor.obj\"\noccluder = [\"wall.obj\"]\nresolution = 64\nsamples = 256\n");
        make_sky({ 1, 1, 1 });
        make_sky({ 1, 1, 1 }, "white.exr", 64, 64);
        make_sky({ 0, 0, 0 }, "black.exr", 64, 64);
        OIIO::ImageBuf halves(OIIO::ImageSpec(64, 64, 3, OIIO::TypeFloat)); // a red floor and a white wall
        for (OIIO::ImageBuf::Iterator<float> p(halves); !p.done(); ++p) {
            const float white = p.x() < 32 ? 0 : 1;
            p[0] = 1, p[1] = white, p[2] = white;
        }
        EXPECT_TRUE(halves.write(path("red_floor.exr"))) << halves.geterror();
    }

    /// Of the middle row.
    float value(const std::string& name, int x, int channel = 0) const
    {
        return pixels(name).values[3 * (32 * 64 + size_t(x)) + size_t(channel)];
    }
};

} // namespace vmlight
