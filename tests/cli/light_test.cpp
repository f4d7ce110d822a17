// SPDX-License-Identifier: Apache-2.0
// Light on the command line: the same light by other ways, and what is no light.
#include "command_test.h"

#include <vmlight/base/format.h>

#include <OpenImageIO/color.h>
#include <OpenImageIO/imagebufalgo.h>

#include <cmath>
#include <limits>

using namespace vmlight;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

namespace {

class Light : public CommandTest
{ };

const std::string kBestModel = ", the best that this visibility map supports";

} // namespace

TEST_F(Light, AConstantSkyLightsByVisibilityAlone)
{
    done("makevismap {spot} -o vm.exr --resolution 128 --samples 16");
    make_sky({ 0.25f, 0.5f, 2 });
    done("makelightmap vm.exr sky.exr -o lit.exr --rotate 10,20,30");
    const Pixels seen = visibility("vm.exr"), lit = pixels("lit.exr");
    ASSERT_EQ(lit.values.size(), 3 * seen.values.size());
    for (size_t i = 0; i < lit.values.size(); ++i)
        ASSERT_NEAR(lit.values[i], seen.values[i / 3] * (i % 3 == 0 ? 0.25f : i % 3 == 1 ? 0.5f : 2), 2e-6);
}

TEST_F(Light, FramesEqualSingleMapsAtTheirAngles)
{
    done("makevismap {spot} -o vm.exr --resolution 64 --samples 16");
    done("makecfem {sky} -o cfem.exr");
    done("makelightmap vm.exr cfem.exr -o lit.####.exr --frames 9-12 --rotate-y 0:270");
    for (const auto& [frame, angle] : { std::pair("0009", 0), { "0010", 90 }, { "0011", 180 }, { "0012", 270 } }) {
        done(format("makelightmap vm.exr cfem.exr -o one.exr --rotate 0,{},0", angle));
        expect_same_pixels(format("lit.{}.exr", frame), "one.exr", 1e-6f);
    }
    EXPECT_FALSE(exists("lit.0013.exr"));
}

TEST_F(Light, AnEnvironmentIsFilteredAsMakecfemWould)
{
    make_vismap();
    done("makecfem {sky} -o cfem.exr");
    done("makelightmap vm.exr cfem.exr -o a.exr");
    done("makelightmap vm.exr {sky} -o b.exr --model paper");
    expect_same_pixels("a.exr", "b.exr", 0);
}

TEST_F(Light, AoNeedsNormals)
{
    done("makevismap {spot} -o vm.exr --resolution 64 --samples 16");
    done("makecfem {sky} -o cfem.exr --resolution 64");
    refused(1, "which makevismap --channels normal adds", "makelightmap vm.exr cfem.exr --model ao -o lit.exr");
    done("makevismap {spot} -o vmn.exr --resolution 64 --samples 16 --channels normal");
    done("makelightmap vmn.exr cfem.exr --model ao -o lit.exr");
    write("n.vismap", "mesh = \"" + kSpot + "\"\nresolution = 64\nsamples = 16\nchannels = [\"normal\"]\n");
    done("makelightmap n.vismap cfem.exr --model ao -o live.exr");
    EXPECT_TRUE(read("live.exr") == read("lit.exr"));
    done("makelightmap vmn.exr cfem.exr -o a.exr");
    done("makelightmap vm.exr cfem.exr -o b.exr");
    expect_same_pixels("a.exr", "b.exr", 0);
}

TEST_F(Light, ABasisLightsByTheModelOfItsName)
{
    done("makecfem {sky} --stack -o stack.exr");
    const struct
    {
        std::string basis, channel;
        size_t floats;
    } cases[] = { { "sh", "sh.24", 25 }, { "mask", "mask.10", 18 }, { "cells", "cells.11", 19 } };
    for (const auto& [basis, channel, floats] : cases) {
        const std::string bake = "makevismap " + kData + "/gazebo.obj --resolution 64 --samples 32 --basis " + basis,
                          turned = " --rotate 0,30,0 ", light = "makelightmap " + basis;
        done(bake + " -o " + basis + ".exr");
        EXPECT_THAT(channel_names(basis + ".exr"), Contains(channel));
        EXPECT_EQ(channel_names(basis + ".exr").size(), floats);
        EXPECT_THAT(done(light + ".exr stack.exr" + turned + "-o a.exr"), HasSubstr("model: " + basis + kBestModel));
        const std::string printed = done(light + ".exr {sky}" + turned + "-o b.exr");
        EXPECT_THAT(printed, HasSubstr("reduce: 512x256 to 128x64")); // no lobe is filtered that is not looked up
        EXPECT_THAT(printed, Not(HasSubstr("filter:")));
        EXPECT_TRUE(read("a.exr") == read("b.exr")) << basis;
        // Live, from recipes: the same bytes.
        write(basis + ".vismap", done(bake + " --print-recipe"));
        write("x.lightmap", done(light + ".vismap {sky}" + turned + "--print-recipe"));
        done("makelightmap x.lightmap -o c.exr");
        EXPECT_TRUE(read("a.exr") == read("c.exr")) << basis;
        shrink(basis + ".exr", "small.exr");
        if (basis == "sh") {
            done(bake + " --order 3 --format half -o half.exr");
            done("makelightmap half.exr stack.exr -o x.exr");
        } else {
            refused(2, "--format half: the basis " + basis + " stores integers that half cannot represent; use float",
                    bake + " --format half -o half.exr");
            refused(1, "no longer whole and below 2^24", "makelightmap small.exr stack.exr -o x.exr");
        }
        EXPECT_NE(attribute("b.exr", "vmlight:cfem_resolution"), "");
        EXPECT_EQ(attribute("b.exr", "vmlight:cfem_filter"), ""); // which was not used
        for (const char* flag : { " --cfem-filter sh", " --cfem-order 4" })
            refused(2, "the model " + basis + " reads the unfiltered environment",
                    light + ".exr {sky} --model " + basis + flag + " -o x2.exr");
    }
    refused(2, "only the basis sh uses it", "makevismap {spot} --order 4 -o x.exr");
    refused(1, "basis: mask needs the measure cosine, not uniform",
            "makevismap {spot} --basis mask --measure uniform -o x.exr");
}

TEST_F(Light, AStackLightsByLobes)
{
    make_vismap();
    done("makecfem {sky} -o cfem.exr");
    EXPECT_THAT(done("makecfem {sky} --stack -o stack.exr"), HasSubstr("to 10 of 128x64"));
    EXPECT_THAT(done("makelightmap vm.exr stack.exr -o stack_lit.exr"), HasSubstr("model: lobe" + kBestModel));
    EXPECT_THAT(done("makelightmap vm.exr {sky} -o env_lit.exr"), HasSubstr("model: lobe" + kBestModel));
    EXPECT_THAT(done("makelightmap vm.exr cfem.exr -o paper_lit.exr"),
                HasSubstr("model: paper, because the CFEM is not a stack"));
    expect_same_pixels("stack_lit.exr", "env_lit.exr", 0);
    // Readers that know nothing of stacks read the first image, a CFEM.
    expect_same_pixels("stack.exr", "cfem.exr", 0);
    done("makelightmap vm.exr stack.exr --model paper -o x.exr");
    expect_same_pixels("x.exr", "paper_lit.exr", 0);
    done("makecfem {sky} --stack -o again.exr --threads 1");
    EXPECT_TRUE(read("again.exr") == read("stack.exr"));
    OIIO::ImageBuf first(path("stack.exr"), 0, 0);
    ASSERT_TRUE(first.write(path("first.exr"))) << first.geterror();
    EXPECT_THAT(done("makelightmap vm.exr first.exr -o x.exr"), HasSubstr("model: paper"));
    refused(1, "\"cfem.exr\": model lobe needs a stack of lobes",
            "makelightmap vm.exr cfem.exr --model lobe -o none.exr");
    done("makecfem {sky} --stack -o half.exr --format half");
    done("makelightmap vm.exr half.exr -o x.exr");
    expect_same_pixels("x.exr", "stack_lit.exr", 0.02f);
}

TEST_F(Light, TheSameLightInTwoColourSpacesGivesTheSameMap)
{
    make_vismap();
    OIIO::ColorConfig config(kConfig);
    OIIO::ImageBuf sky(kData + "/studio_small_03.hdr");
    const OIIO::ImageBuf converted
        = OIIO::ImageBufAlgo::colorconvert(sky, "lin_rec709_scene", "ACEScg", true, "", "", &config);
    ASSERT_TRUE(converted.write(path("sky_acescg.exr"), OIIO::TypeFloat)) << converted.geterror();
    done("makelightmap vm.exr {sky} --colorconfig {config} -o a.exr --colorspace lin_rec709_scene");
    done("makelightmap vm.exr sky_acescg.exr --colorconfig {config} -o b.exr --colorspace ACEScg");
    expect_same_pixels("a.exr", "b.exr", 1e-4f);
    refused(1, "Nonsense", "makelightmap vm.exr {sky} --colorconfig {config} -o x.exr --colorspace Nonsense");
    refused(1, "needs an OCIO config: set --colorconfig or $OCIO", "makecfem {sky} --colorspace ACEScg -o x.exr");
    refused(1, "missing.ocio", "makecfem {sky} --colorconfig missing.ocio -o x.exr");
}

TEST_F(Light, AlbedoMultipliesInLinearLight)
{
    make_vismap();
    make_sky({ 1, 1, 1 });
    OIIO::ImageBuf gray(OIIO::ImageSpec(8, 8, 3, OIIO::TypeUInt8));
    OIIO::ImageBufAlgo::fill(gray, { 0.5f, 0.5f, 0.5f });
    ASSERT_TRUE(gray.write(path("gray.png"))) << gray.geterror();
    done("makelightmap vm.exr sky.exr --albedo gray.png -o lit.exr");
    for (const float value : pixels("lit.exr").values)
        ASSERT_NEAR(value, 0.215861, 1e-4); // sRGB 128 in linear light
    refused(1, "no such file", "makelightmap vm.exr sky.exr --albedo gone.png -o x.exr");
}

// PNG, TIFF and Targa keep colour and alpha apart; their readers multiply encoded colour by alpha unless asked not to.
TEST_F(Light, AlphaLeavesColourAlone)
{
    make_vismap();
    make_sky({ 1, 1, 1 });
    const auto make = [&](const std::string& name, float alpha, int width, int height) {
        OIIO::ImageSpec spec(width, height, 4, OIIO::TypeUInt8);
        spec.attribute("oiio:UnassociatedAlpha", 1);
        OIIO::ImageBuf image(spec);
        OIIO::ImageBufAlgo::fill(image, { 0.5f, 0.5f, 0.5f, alpha });
        ASSERT_TRUE(image.write(path(name))) << image.geterror();
    };
    for (const std::string format : { "png", "tif", "tga" })
        for (const float alpha : { 1.0f, 0.5f, 0.0f }) {
            SCOPED_TRACE(vmlight::format("{} alpha {}", format, alpha));
            make("albedo." + format, alpha, 8, 8);
            make("light." + format, alpha, 16, 8);
            EXPECT_THAT(done("makelightmap vm.exr sky.exr --albedo albedo." + format + " -o lit.exr"),
                        HasSubstr("albedo: srgb_rec709_scene -> lin_rec709_scene (no OCIO config); alpha is ignored"));
            EXPECT_THAT(done("makecfem light." + format + " -o cfem.exr"), HasSubstr("; alpha is ignored"));
            for (const char* image : { "lit.exr", "cfem.exr" })
                for (const float value : pixels(image).values)
                    ASSERT_NEAR(value, 0.215861, 1e-4) << image; // sRGB 128 in linear light
            write("x.lightmap", "vismap = \"vm.exr\"\nenvironment = \"sky.exr\"\nalbedo = \"albedo." + format + "\"\n");
            done("makelightmap x.lightmap -o live.exr");
            expect_same_pixels("lit.exr", "live.exr", 0);
        }
    // The colour of an EXR is multiplied by alpha by definition: it is the light that is there.
    OIIO::ImageBuf glow(OIIO::ImageSpec(16, 8, 4, OIIO::TypeFloat));
    OIIO::ImageBufAlgo::fill(glow, { 2, 2, 2, 0.25f });
    ASSERT_TRUE(glow.write(path("glow.exr"))) << glow.geterror();
    EXPECT_THAT(done("makecfem glow.exr -o cfem.exr"), HasSubstr("unchanged (no OCIO config); alpha is ignored"));
    for (const float value : pixels("cfem.exr").values)
        ASSERT_NEAR(value, 2, 1e-5);
}

TEST_F(Light, WhatIsNotLightOrVisibilityIsRefused)
{
    make_vismap();
    done("makecfem {sky} -o cfem.exr");
    done("makelightmap vm.exr cfem.exr -o lit.exr");
    refused(1, "not a visibility map", "makelightmap cfem.exr cfem.exr -o x.exr");
    refused(1, "not a visibility map", "makelightmap lit.exr cfem.exr -o x.exr");
    refused(1, "neither an environment nor a CFEM", "makelightmap vm.exr vm.exr -o x.exr");
    refused(1, "neither an environment nor a CFEM", "makelightmap vm.exr lit.exr -o x.exr");
    refused(1, "visibility map", "makecfem vm.exr -o x.exr");
    std::string noise;
    for (int i = 0; i < 256 * 16; ++i)
        noise += char(i);
    const std::pair<std::string, std::string> files[] = { { "noise.exr", noise },
                                                          { "noise.hdr", "#?RADIANCE\n\n-Y 4 +X 4\n" },
                                                          { "empty.exr", "" },
                                                          { "cut.exr", read("cfem.exr").substr(0, 5000) } };
    for (const auto& [name, bytes] : files) {
        write(name, bytes);
        refused(1, "\"" + name + "\": ", "makecfem " + name + " -o x.exr");
        refused(1, "\"" + name + "\": ", "makelightmap vm.exr " + name + " -o x.exr");
        refused(1, "\"" + name + "\": ", "makelightmap " + name + " cfem.exr -o x.exr");
    }
}

TEST_F(Light, BadPixelsAreRefusedUnlessSanitizeIsGiven)
{
    // A little-endian PFM of 8x4 pixels, of which one is bad; each row the same backwards, as OIIO 3.1 flips them.
    std::string rows;
    for (int y = 0; y < 4; ++y)
        for (int x = 7; x >= 0; --x) {
            const bool bad = y == 2 && x == 5;
            const float pixel[] = { bad ? NAN : 1, bad ? std::numeric_limits<float>::infinity() : 1, bad ? -1.f : 1 };
            rows.append(reinterpret_cast<const char*>(pixel), sizeof(pixel));
        }
    write("bad.pfm", "PF\n8 4\n-1.0\n" + rows);
    refused(1, "environment has 3 values that are NaN, infinite or negative, the first at pixel (2, ",
            "makecfem bad.pfm -o x.exr");
    EXPECT_THAT(done("makecfem bad.pfm -o x.exr --sanitize"),
                HasSubstr("3 bad values of the environment were repaired"));
    expect_finite("x.exr");
}
