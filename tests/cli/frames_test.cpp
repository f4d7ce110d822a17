// SPDX-License-Identifier: Apache-2.0
// Exposure from the picture, and inputs with a file for each frame.
#include "command_test.h"

#include <vmlight/base/format.h>

#include <cmath>

using namespace vmlight;
using testing::HasSubstr;
using testing::Not;

namespace {

class Frames : public CommandTest
{
protected:
    // Luminance of a gray lightmap of the open quad.
    float level(const std::string& name) const { return pixels(name).greatest(); }
};

} // namespace

TEST_F(Frames, TheLightIsPrintedWithTheExposureThatMakesItMiddleGray)
{
    make_vismap();
    make_sky({ 0.36f, 0.36f, 0.36f });
    const std::string said = done("makelightmap vm.exr sky.exr -o lit.exr");
    EXPECT_THAT(said, HasSubstr("mean 0.36, 95th percentile 0.36; --exposure -1.00 brings the mean to 0.18\n"));
    EXPECT_THAT(done("makelightmap vm.exr sky.exr -o up.exr --exposure 2"),
                HasSubstr("mean 1.44, 95th percentile 1.44; --exposure -1.00 brings the mean to 0.18\n"));
    done("makelightmap vm.exr sky.exr -o zero.exr --exposure 0");
    EXPECT_EQ(read("zero.exr"), read("lit.exr"));
    make_sky({ 0, 0, 0 }, "night.exr");
    EXPECT_THAT(done("makelightmap vm.exr night.exr -o dark.exr"), HasSubstr("light: no texel is lit\n"));
    EXPECT_EQ(run("makelightmap vm.exr sky.exr -o lit.exr --quiet").out, "");
}

TEST_F(Frames, AnExposureThatCannotReachMiddleGrayIsSaidTo)
{
    make_vismap();
    make_sky({ 1e-25f, 1e-25f, 1e-25f }, "dim.exr");
    EXPECT_THAT(done("makelightmap vm.exr dim.exr -o lit.exr"),
                HasSubstr("; no --exposure brings the mean to 0.18: 64.00 brings it to 1.84e-06\n"));
    EXPECT_THAT(done("makelightmap vm.exr dim.exr -o lit.exr --exposure auto"),
                HasSubstr("WARNING: --exposure auto: no --exposure brings the mean to 0.18: 64.00 brings it to"));
    EXPECT_EQ(attribute("lit.exr", "vmlight:exposure"), "64");
    for (const char* exposure : { "", " --exposure auto" })
        EXPECT_THAT(done(std::string("vmframes quad.obj dim.exr --resolution 16 --size 16 -o lit.png") + exposure),
                    HasSubstr("no --exposure brings the mean to 0.18: 64.00 brings it to"));
}

TEST_F(Frames, AutomaticExposureIsTheSameAsItsStops)
{
    make_vismap();
    make_sky({ 0.5f, 0.25f, 1 });
    EXPECT_THAT(done("makelightmap vm.exr sky.exr -o lit.exr --exposure auto"),
                HasSubstr("stops, for all frames and tiles"));
    const std::string stops = attribute("lit.exr", "vmlight:exposure");
    EXPECT_THAT(stops, HasSubstr("-"));
    done("makelightmap vm.exr sky.exr -o same.exr --exposure " + stops);
    EXPECT_EQ(read("lit.exr"), read("same.exr"));
    const Pixels lit = pixels("lit.exr");
    EXPECT_NEAR(0.2126 * lit.values[0] + 0.7152 * lit.values[1] + 0.0722 * lit.values[2], 0.18, 0.18 * 0.004);
    // The last one counts.
    done("makelightmap vm.exr sky.exr -o last.exr --exposure auto --exposure " + stops);
    EXPECT_EQ(read("lit.exr"), read("last.exr"));
    make_sky({ 0, 0, 0 }, "night.exr");
    EXPECT_THAT(done("makelightmap vm.exr night.exr -o dark.exr --exposure auto"),
                HasSubstr("WARNING: --exposure auto: no texel is lit in the first frame, so 0 stops for all"));
    refused(2, "exposure: \"automatic\" is not a number", "makelightmap vm.exr sky.exr -o x.exr --exposure automatic");
    refused(2, "--exposure auto cannot be saved in a recipe",
            "makelightmap vm.exr sky.exr --exposure auto --print-recipe");
}

TEST_F(Frames, OneExposureForAllFrames)
{
    make_vismap();
    make_sky({ 0.36f, 0.36f, 0.36f }, "sky.0001.exr");
    make_sky({ 0.72f, 0.72f, 0.72f }, "sky.0002.exr");
    done("makelightmap vm.exr sky.####.exr --frames 1-2 -o lit.####.exr --exposure auto");
    EXPECT_EQ(attribute("lit.0001.exr", "vmlight:exposure"), "-1");
    EXPECT_EQ(attribute("lit.0002.exr", "vmlight:exposure"), "-1");
    EXPECT_NEAR(level("lit.0001.exr"), 0.18, 1e-5);
    EXPECT_NEAR(level("lit.0002.exr"), 0.36, 1e-5);
}

TEST_F(Frames, AnEnvironmentForEachFrame)
{
    make_vismap();
    for (int frame = 8; frame <= 10; ++frame)
        make_sky({ 0.1f * float(frame), 0.2f, 0.3f }, format("sky.{:04}.exr", frame));
    const std::string said = done("makelightmap vm.exr sky.####.exr --frames 8-10 -o lit.####.exr");
    for (int frame = 8; frame <= 10; ++frame) {
        done(format("makelightmap vm.exr sky.{:04}.exr -o one.exr", frame));
        EXPECT_EQ(read(format("lit.{:04}.exr", frame)), read("one.exr")) << frame;
        // Filtered before: the same, once it is known to be a CFEM.
        done(format("makecfem sky.{0:04}.exr -o cfem.{0:04}.exr", frame));
    }
    EXPECT_NE(read("lit.0008.exr"), read("lit.0009.exr"));
    done("makelightmap vm.exr cfem.####.exr --frames 8-10 -o of_cfem.####.exr");
    done("makelightmap vm.exr cfem.0009.exr -o one.exr");
    EXPECT_EQ(read("of_cfem.0009.exr"), read("one.exr"));
    refused(1, "\"sky.0011.exr\": no such file\n", "makelightmap vm.exr sky.####.exr --frames 10-11 -o x.####.exr");
    refused(1, "\"sky.0011.exr\": no such file; frames 11, 12 are missing\n",
            "makelightmap vm.exr sky.####.exr --frames 8-12 -o x.####.exr");
    refused(1, "\"sky.0011.exr\": no such file; frames 11, 12, 13, 14, 15 and 85 more are missing\n",
            "makelightmap vm.exr sky.####.exr --frames 8-100 -o x.####.exr");
    EXPECT_FALSE(exists("x.0008.exr")) << "before any is made";
    done("makelightmap vm.exr 'made.#.null?RES=64x32&CHANNELS=3' --frames 1-2 -o made.#.exr"); // by a plugin of OIIO's
    refused(1, "\"sky.11.lightmap\": no such file",
            "makelightmap vm.exr sky.exr --albedo 'sky.##.lightmap?exposure=1' "
            "--frames 11 -o x.#.exr");
}

TEST_F(Frames, AMapAndAnAlbedoForEachFrame)
{
    make_vismap();
    make_sky({ 0.5f, 0.5f, 0.5f });
    make_sky({ 0.25f, 0.25f, 0.25f }, "paint.1.exr");
    make_sky({ 0.75f, 0.75f, 0.75f }, "paint.2.exr");
    write("vm.1.exr", read("vm.exr"));
    done("makevismap quad.obj -o vm.2.exr --resolution 8 --samples 4 --margin 0");
    done("makelightmap vm.#.exr sky.exr --albedo paint.#.exr --frames 1-2 -o lit.#.exr");
    done("makelightmap vm.1.exr sky.exr --albedo paint.1.exr -o one.exr");
    done("makelightmap vm.2.exr sky.exr --albedo paint.2.exr -o two.exr");
    EXPECT_EQ(read("lit.1.exr"), read("one.exr"));
    EXPECT_EQ(read("lit.2.exr"), read("two.exr"));
    EXPECT_NE(pixels("one.exr").values, pixels("two.exr").values);
    // As a recipe's input too.
    write("hero.lightmap", "vismap = \"vm.#.exr\"\nenvironment = \"sky.exr\"\nalbedo = \"paint.#.exr\"\n");
    done("makelightmap hero.lightmap --frames 1-2 -o again.#.exr");
    EXPECT_EQ(read("again.2.exr"), read("two.exr"));
}

TEST_F(Frames, ASequenceNeedsFrames)
{
    make_vismap();
    make_sky({ 1, 1, 1 }, "sky.0001.exr");
    const std::string reason = "\": no such file, and no frames: a sequence needs --frames, such as 1-48";
    refused(2, "environment: \"sky.####.exr" + reason, "makelightmap vm.exr sky.####.exr -o x.exr");
    refused(2, "vismap: \"vm.#.exr" + reason, "makelightmap vm.#.exr sky.0001.exr -o x.exr");
    refused(2, "albedo: \"a.#.exr" + reason, "makelightmap vm.exr sky.0001.exr --albedo a.#.exr -o x.exr");
    refused(2, "mesh: \"m.#.obj" + reason, "makelightmap vm.exr sky.0001.exr --suns on --mesh m.#.obj -o x.exr");
    refused(
        2, "occluder: \"o.#.obj" + reason,
        "makelightmap vm.exr sky.0001.exr --suns on --mesh quad.obj --occluder quad.obj --occluder o.#.obj -o x.exr");
    // A name that has one.
    write("take#3.exr", read("sky.0001.exr"));
    done("makelightmap vm.exr take#3.exr -o lit.exr");
    refused(2, "frames: all frames are the same: give --rotate-y FIRST:LAST, or #### in the name of an input",
            "makelightmap vm.exr take#3.exr --frames 1-2 -o lit.#.exr");
    done("makelightmap vm.exr take#3.exr --frames 1-2 --rotate-y 0:90 -o lit.#.exr"); // of light that is all the same
    EXPECT_EQ(pixels("lit.2.exr").values, pixels("lit.exr").values);
}
