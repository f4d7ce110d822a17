// SPDX-License-Identifier: Apache-2.0
// vmframes on the command line: what it writes.
#include "vmframes_run.h"

#include "image_count.h"

#include <OpenImageIO/imagebuf.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

using namespace vmlight;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

namespace {

using Vmframes = VmframesTest;

} // namespace

// The open quad sends out the sky's one colour.
TEST_F(Vmframes, AnExrIsTheLight)
{
    done("vmframes quad.obj sky.exr -o a.exr --layers lit,depth,visibility --elevation 0 --fill 4" + small);
    EXPECT_THAT(channel_names("a.exr"),
                testing::UnorderedElementsAre("R", "G", "B", "A", "lit.R", "lit.G", "lit.B", "depth.Z", "visibility"));
    OIIO::ImageBuf image(path("a.exr"));
    EXPECT_NEAR(image.getchannel(8, 8, 0, 0), 1, 1e-6);
    EXPECT_NEAR(image.getchannel(8, 8, 0, 2), 3, 3e-6);
    EXPECT_EQ(image.getchannel(8, 8, 0, 3), 1);
    const std::vector<std::string> channels = channel_names("a.exr");
    const auto visibility = std::find(channels.begin(), channels.end(), "visibility") - channels.begin();
    EXPECT_NEAR(image.getchannel(8, 8, 0, int(visibility)), 1, 1e-6); // an open quad
    EXPECT_EQ(attribute("a.exr", "colorInteropID"), "lin_rec709_scene");
    done("vmframes quad.obj sky.exr -o b.exr --elevation 0 --fill 4 --exposure 1 --format half" + small);
    EXPECT_NEAR(OIIO::ImageBuf(path("b.exr")).getchannel(8, 8, 0, 0), 2, 1e-3);
}

TEST_F(Vmframes, AutoExposureBringsTheObjectToMiddleGrey)
{
    EXPECT_THAT(done("vmframes quad.obj sky.exr -o a.exr --elevation 0 --exposure auto --ground white" + small),
                HasSubstr("exposure: -"));
    OIIO::ImageBuf image(path("a.exr"));
    double luminance = 0;
    for (int c = 0; c < 3; ++c)
        luminance += std::vector<double> { 0.2126, 0.7152, 0.0722 }[size_t(c)] * double(image.getchannel(8, 8, 0, c));
    EXPECT_NEAR(luminance, 0.18, 0.02); // the ground is in the way of a little
    const std::string said = done("vmframes quad.obj sky.exr -o a.exr --elevation 0" + small);
    EXPECT_THAT(said, HasSubstr("brings the mean to 0.18"));
    EXPECT_THAT(said, HasSubstr("\nmodel: " + attribute("a.exr", "vmlight:model") + ", the best that"));
}

TEST_F(Vmframes, FramesTurnOnceAround)
{
    const std::string line = "vmframes " + kSpot + " " + kSky + small + " --frames 1-4 -o ";
    done(line + "'a.##.exr' --turntable --contact-sheet sheet.png");
    EXPECT_THAT(names("a."), ElementsAre("a.01.exr", "a.02.exr", "a.03.exr", "a.04.exr"));
    EXPECT_TRUE(exists("sheet.png"));
    done(line + "'d.##.exr' --turntable --rotate 0,90,0");
    expect_same_pixels("a.02.exr", "d.01.exr", 1e-3f);
    // Turning the object by a quarter is seen by a camera that goes a quarter the other way, in light turned along.
    done("vmframes " + kSpot + " " + kSky + small + " --azimuth -90 --env-rotate 0,-90,0 -o b.exr");
    done("vmframes " + kSpot + " " + kSky + small + " --rotate 0,90,0 -o c.exr");
    expect_same_pixels("b.exr", "c.exr", 1e-3f);
    done(line + "film.gif --turn-environment");
    EXPECT_EQ(image_count(path("film.gif")), 4);
    EXPECT_THAT(names(), Not(testing::Contains(HasSubstr(".part"))));
}

TEST_F(Vmframes, FilmsAreMadeByFfmpeg)
{
    const std::string line = "vmframes quad.obj sky.exr --frames 1-3 --turntable -o film.mp4" + small;
    if (std::system("ffmpeg -version >/dev/null 2>&1") != 0) {
        refused(2, "films need ffmpeg, which is not installed", line);
        GTEST_SKIP() << "ffmpeg is not installed";
    }
    done(line);
    EXPECT_EQ(read("film.mp4").substr(4, 4), "ftyp");
    EXPECT_THAT(names(), Not(testing::Contains(HasSubstr(".part"))));
}

// A program of that name, by what it is called with: all frames go to it, and nothing is left of one that fails.
TEST_F(Vmframes, FilmsAreOneProcess)
{
    const std::string before = std::getenv("PATH");
    ::setenv("PATH", (path("tools") + ":" + before).c_str(), 1);
    std::filesystem::create_directory(path("tools"));
    const auto install = [&](const std::string& text) {
        write("tools/ffmpeg", "#!/bin/sh\n[ \"$1\" = -version ] && exit 0\n" + text);
        std::filesystem::permissions(path("tools/ffmpeg"), std::filesystem::perms::owner_all);
    };
    const std::string line = "vmframes quad.obj sky.exr --frames 1-3 --turntable --fps 30 -o film.webm" + small;
    install("echo \"$*\" >arguments\nfor last; do :; done\ncat >\"${last#file:}\"\n");
    done(line);
    EXPECT_EQ(read("film.webm").size(), 3u * 16 * 16 * 3) << "frames of R, G, B";
    EXPECT_THAT(read("arguments"), HasSubstr("-f rawvideo -pix_fmt rgb24 -s 16x16 -r 30 -i pipe:0 "));
    remove("film.webm");
    install("exit 3\n");
    refused(1, "\"film.webm\": ffmpeg failed with exit code 3", line);
    ::setenv("PATH", before.c_str(), 1);
    remove("arguments");
    std::filesystem::remove_all(path("tools"));
}

TEST_F(Vmframes, BackgroundsAreBehind)
{
    const std::string line = "vmframes quad.obj sky.exr --elevation 0 --fill .2 --exposure 1" + small;
    const auto corner = [&](const std::string& name, const std::string& background) {
        done(line + " --background " + background + " -o " + name);
        float rgba[4] = {};
        OIIO::ImageBuf(path(name)).getpixel(0, 0, rgba);
        return std::vector<float>(rgba, rgba + 4);
    };
    const auto near = [](float r, float g, float b, float a) {
        return testing::Pointwise(testing::FloatNear(1e-4f), std::vector<float> { r, g, b, a });
    };
    EXPECT_THAT(corner("a.exr", "none"), near(0, 0, 0, 0));
    EXPECT_THAT(corner("b.exr", "environment"), near(2, 4, 6, 1));
    EXPECT_THAT(corner("c.exr", ".25,.5,1"), near(.5f, 1, 2, 1)) << "scene-linear: exposed too";
}

TEST_F(Vmframes, ModelsAreCompared)
{
    const std::string text = done("vmframes " + kSpot + " " + kSky + small
                                  + " --reference-samples 8 --side-by-side ao,paper,lobe,sh,cells,reference -o a.exr");
    EXPECT_THAT(text, HasSubstr("relative RMS against reference: ao "));
    EXPECT_EQ(pixels("a.exr").width, 6 * 16);
    EXPECT_THAT(attribute("a.exr", "vmlight:compared"), HasSubstr("against reference: ao "));
    EXPECT_THAT(done("vmframes " + kSpot + " " + kSky + small + " --wipe paper,paper -o b.png"),
                HasSubstr("against paper: paper 0.0000"));
}

TEST_F(Vmframes, MapsAndTexturesThatAreThereAreUsed)
{
    const std::string line = "vmframes " + kSpot + " " + kSky, filter = " --cfem-resolution 16";
    done(line + small + " --keep kept -o a.exr");
    EXPECT_THAT(names("", "kept"), ElementsAre("spot_lightmap.exr", "spot_vismap.exr"));
    EXPECT_THAT(done(line + few + filter + " --vismap kept/spot_vismap.exr -o b.exr"), Not(HasSubstr("bake:")));
    expect_same_pixels("a.exr", "b.exr", 0);
    // The lightmap itself, through OIIO's texture system: the margin and other filters alone are different.
    done("vmframes " + kSpot + " --texture kept/spot_lightmap.exr --size 16 --spp 4 -o c.exr");
    refused(1, "not a lightmap: its vmlight:stage is \"vismap\"",
            "vmframes " + kSpot + " --texture kept/spot_vismap.exr --size 16 -o x.exr");
    make_sky({ 1, 1, 1 }, "albedo.png");
    EXPECT_THAT(done("vmframes " + kSpot + " --texture albedo.png --size 16 -o d.exr"),
                HasSubstr("WARNING: \"albedo.png\": has integer pixels, as albedo textures do; shown as light"));
    EXPECT_NEAR(mean("c.exr"), mean("a.exr"), 0.2 * mean("a.exr"));
    // A sequence, and a recipe that is lit as it is looked up.
    for (const char* name : { "t.1.exr", "t.2.exr" })
        write(name, read("kept/spot_lightmap.exr"));
    done("vmframes " + kSpot + " --texture 't.#.exr' --size 16 --spp 4 --frames 1-2 -o 'd.#.exr'");
    expect_same_pixels("c.exr", "d.2.exr", 0);
    refused(1, "\"t.3.exr\"", "vmframes " + kSpot + " --texture 't.#.exr' --size 16 --frames 3 -o 'e.#.exr'");
    write("live.lightmap", "vismap = \"kept/spot_vismap.exr\"\nenvironment = \"" + kSky + "\"\n");
    done("vmframes " + kSpot + " --texture live.lightmap?cfem_resolution=16 --size 16 --spp 4 -o f.exr");
    expect_same_pixels("c.exr", "f.exr", 1e-3f);
    EXPECT_THAT(done("vmframes quad.obj " + kSky + few + " --vismap kept/spot_vismap.exr -o g.png"),
                HasSubstr("was baked from another mesh than \"quad.obj\""));
    write("bare.obj", kQuadWithoutUv);
    EXPECT_THAT(done("vmframes bare.obj sky.exr --keep made -o d.png" + small), HasSubstr("no UVs; "));
    EXPECT_THAT(names("", "made"), testing::Contains("bare_unwrapped.glb"));
    refused(1, "texture coordinates", "vmframes bare.obj sky.exr --vismap kept/spot_vismap.exr -o e.png" + few);
}

TEST_F(Vmframes, PicturesAreShownThroughTheConfig)
{
    const std::string line = "vmframes quad.obj sky.exr --colorconfig {config} --exposure -3 -o ";
    EXPECT_THAT(done(line + "a.png" + small), HasSubstr("display: "));
    EXPECT_TRUE(exists("a.png"));
    refused(1, "has no display \"Tube\"; it has ", line + "b.png --display Tube" + small);
}
