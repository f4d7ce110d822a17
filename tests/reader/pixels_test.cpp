// SPDX-License-Identifier: Apache-2.0
// A recipe gives a host the bits that the executable writes.
#include "reader_case.h"

using namespace vmlight;
using testing::HasSubstr;

namespace {

using ReaderPixels = ReaderTest;

/// UDIM: a quad in tile 1001 and one in 1012, at an angle.
class ReaderTiles : public ReaderTest
{
protected:
    void SetUp() override
    {
        ReaderTest::SetUp();
        write("corner.obj",
              "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 1 -1 2\nv 1 1 2\nvn 0 0 1\nvn -1 0 0\n"
              "vt 0.125 0.125\nvt 0.875 0.125\nvt 0.875 0.75\nvt 0.125 0.75\n"
              "vt 1.125 1.125\nvt 1.875 1.125\nvt 1.875 1.75\nvt 1.125 1.75\n"
              "f 1/1/1 2/2/1 3/3/1 4/4/1\nf 2/5/2 5/6/2 6/7/2 3/8/2\n");
        write("corner.vismap", "mesh = \"corner.obj\"\nresolution = 100\nsamples = 8\n");
        write("corner.lightmap", "vismap = \"vm.<UDIM>.exr\"\ncfem = \"studio.cfem\"\n");
        done("makevismap corner.obj -o vm.<UDIM>.exr --resolution 100 --samples 8");
        done("makelightmap vm.<UDIM>.exr studio.cfem -o lit.<UDIM>.exr");
    }
};

} // namespace

TEST_F(ReaderPixels, ARecipeAndTheExecutableGiveTheSameBits)
{
    done("makevismap spot.obj -o vm.exr --resolution 200x150 --samples 8");
    done("makecfem studio.hdr -o cfem.exr --resolution 64");
    done("makelightmap vm.exr cfem.exr -o lit.exr --rotate 0,30,0");
    expect_same_pixels("hero.vismap", "vm.exr", 0);
    expect_same_pixels("studio.cfem", "cfem.exr", 0);
    expect_same_pixels("hero.lightmap", "lit.exr", 0);
    // Converted by the host, and from stored inputs.
    convert("hero.lightmap", "converted.exr");
    expect_same_pixels("converted.exr", "lit.exr", 0);
    write("stored.lightmap", "vismap = \"vm.exr\"\ncfem = \"cfem.exr\"\nrotate = [0, 30, 0]\n");
    expect_same_pixels("stored.lightmap", "lit.exr", 0);
    write("env.lightmap", "vismap = \"vm.exr\"\nenvironment = \"studio.hdr\"\ncfem_resolution = 64\n");
    expect_same_pixels("env.lightmap?rotate=0,30,0&model=paper", "lit.exr", 0);
}

TEST_F(ReaderPixels, LightWithoutSunsBouncesAlsoWhereSunsAreAskedFor)
{
    make_sky({ 1, 2, 3 }, "paint.exr", 8, 8);
    write("grove.lightmap",
          "vismap = \"vm.exr\"\nenvironment = \"" + std::string(VMLIGHT_TEST_DATA)
              + "/forest_slope.hdr\"\nmesh = \"spot.obj\"\nalbedo = \"paint.exr\"\nsuns = \"auto\"\n"
                "bounce = \"auto\"\nbounce_rays = 8\n");
    done("makevismap spot.obj -o vm.exr --resolution 64 --samples 4");
    EXPECT_THAT(done("makelightmap grove.lightmap -o lit.exr"), HasSubstr("suns: none"));
    expect_same_pixels("grove.lightmap", "lit.exr", 0);
}

TEST_F(ReaderPixels, AStackIsSubimagesAndLightsByLobes)
{
    done("makevismap hero.vismap -o vm.exr");
    done("makecfem studio.hdr -o stack.exr --resolution 64 --stack");
    done("makelightmap vm.exr stack.exr -o lobe.exr --rotate 0,30,0 --model lobe");
    const auto stack = OIIO::ImageInput::open("studio.cfem?stack=true");
    ASSERT_TRUE(stack) << OIIO::geterror();
    bool has_narrow_lobe = false;
    int levels = 0;
    for (; stack->seek_subimage(levels, 0); ++levels) {
        has_narrow_lobe |= stack->spec().get_float_attribute("vmlight:lobe") == 0.5f;
        const Pixels live = pixels("studio.cfem?stack=true", levels), stored = pixels("stack.exr", levels);
        EXPECT_EQ(live.width, stored.width) << levels;
        EXPECT_TRUE(live.values == stored.values) << levels;
    }
    EXPECT_EQ(levels, 10);
    EXPECT_TRUE(has_narrow_lobe);
    EXPECT_FALSE(OIIO::ImageInput::open("stack.exr")->seek_subimage(levels, 0));
    expect_same_pixels("studio.cfem", "stack.exr", 0); // the first level is the CFEM

    write("stack.cfem", "environment = \"studio.hdr\"\nresolution = 64\nstack = true\n");
    write("env.lightmap", "vismap = \"vm.exr\"\nenvironment = \"studio.hdr\"\ncfem_resolution = 64\n");
    write("a.lightmap", "vismap = \"hero.vismap\"\ncfem = \"stack.cfem\"\n");
    write("b.lightmap", "vismap = \"vm.exr\"\ncfem = \"stack.exr\"\nmodel = \"auto\"\n");
    for (const std::string name : { "env", "a", "b" })
        expect_same_pixels(name + ".lightmap?rotate=0,30,0", "lobe.exr", 0);
    EXPECT_EQ(attribute("a.lightmap", "vmlight:model"), "lobe");
    EXPECT_EQ(attribute("hero.lightmap", "vmlight:model"), "paper");
    expect_error("makecfem --stack", "hero.lightmap?model=lobe");

    done("makevismap hero.vismap?channels=normal -o vmn.exr");
    expect_same_pixels("hero.vismap?channels=normal", "vmn.exr", 0);
    write("ao.lightmap", "vismap = \"vmn.exr\"\ncfem = \"stack.cfem\"\nmodel = \"ao\"\n");
    done("makelightmap vmn.exr stack.exr -o ao.exr --model ao");
    expect_same_pixels("ao.lightmap", "ao.exr", 0);
    write("plain.lightmap", "vismap = \"hero.vismap\"\ncfem = \"stack.cfem\"\nmodel = \"ao\"\n");
    expect_error("makevismap --channels normal", "plain.lightmap");
}

TEST_F(ReaderPixels, ATargetErrorIsMetLive)
{
    const std::string noisy = "hero.vismap?target_error=0.05&channels=error,normal";
    done("makevismap " + noisy + " -o noisy.exr");
    // An EXR has its channels in another order.
    const std::vector<std::string> ours = channel_names(noisy), theirs = channel_names("noisy.exr");
    EXPECT_THAT(ours, testing::UnorderedElementsAreArray(theirs));
    EXPECT_THAT(ours,
                testing::UnorderedElementsAre("visibility", "direction.x", "direction.y", "direction.z", "normal.x",
                                              "normal.y", "normal.z", "error"));
    const Pixels live = pixels(noisy), stored = pixels("noisy.exr");
    ASSERT_EQ(live.values.size(), stored.values.size());
    for (size_t c = 0; c < ours.size(); ++c) {
        const size_t other = size_t(std::find(theirs.begin(), theirs.end(), ours[c]) - theirs.begin());
        for (size_t i = 0; i < live.values.size(); i += ours.size())
            ASSERT_EQ(live.values[i + c], stored.values[i + other]) << ours[c];
    }
    EXPECT_EQ(attribute(noisy, "vmlight:samples"), ""); // nothing is baked yet
    EXPECT_NE(attribute("noisy.exr", "vmlight:samples"), "");
    expect_error("target_error: 1e-09 is out of reach", "hero.vismap?target_error=1e-9&resolution=16");
}

// The albedo is of another space than the light, and both of another than the output.
TEST_F(ReaderPixels, ColourOfAnotherSpaceIsConvertedByTile)
{
    const std::string color = "--albedo albedo.exr --albedo-colorspace lin_rec709_scene "
                              "--output-colorspace lin_rec2020_scene -o lit.exr";
    done("makecfem studio.hdr -o albedo.exr --resolution 64");
    done("makelightmap hero.vismap studio.cfem " + color);
    write("color.lightmap",
          "vismap = \"hero.vismap\"\ncfem = \"studio.cfem\"\nalbedo = \"albedo.exr\"\n"
          "albedo_colorspace = \"lin_rec709_scene\"\noutput_colorspace = \"lin_rec2020_scene\"\n");
    expect_same_pixels("color.lightmap", "lit.exr", 0);
    EXPECT_EQ(attribute("lit.exr", "colorInteropID"), "lin_rec2020_scene");
    done("makelightmap hero.vismap studio.cfem -o plain.exr");
    EXPECT_NE(pixels("plain.exr").values, pixels("lit.exr").values);
}

TEST_F(ReaderPixels, AnExecutableReadsRecipesWhereItReadsImages)
{
    done("makelightmap hero.vismap studio.cfem -o lit.exr --rotate 0,30,0");
    expect_same_pixels("hero.lightmap", "lit.exr", 0);
}

TEST_F(ReaderTiles, ATileHasTheBitsOfTheExecutable)
{
    for (const std::string udim : { "1001", "1012" }) {
        expect_same_pixels("corner.vismap?udim=" + udim, "vm." + udim + ".exr", 0);
        const std::string lit = "lit." + udim + ".exr", link = "link." + udim + ".lightmap";
        expect_same_pixels("corner.lightmap?udim=" + udim, lit, 0);
        expect_same_pixels("corner.lightmap?udim=" + udim + "&vismap=corner.vismap?udim=<UDIM>", lit, 0);
        std::filesystem::create_symlink("corner.lightmap", link);
        expect_same_pixels(link, lit, 0);
        convert(link, "out.exr");
        expect_same_pixels("out.exr", lit, 0);
    }
}

TEST_F(ReaderTiles, ABadTileIsRefused)
{
    expect_error("corner.lightmap?udim=1000", "corner.lightmap?udim=1000");
    write("bad.lightmap", "vismap = \"vm.<UDIM>.exr\"\ncfem = \"studio.cfem\"\nudim = 1002\n");
    expect_error("vm.1002.exr", "bad.lightmap");
}
