// SPDX-License-Identifier: Apache-2.0
// Suns on the command line: split off, traced, and never lost.
#include "command_test.h"

#include <OpenImageIO/imagebuf.h>

#include <cmath>

using namespace vmlight;
using testing::HasSubstr;
using testing::Not;

namespace {

class Suns : public CommandTest
{
protected:
    // A sun at 45 degrees above the horizon that +x is on, in a constant sky; and a floor that looks up, with a wall on
    // its right that is twice as high as the floor is wide.
    Suns()
    {
        OIIO::ImageBuf sky(OIIO::ImageSpec(512, 256, 3, OIIO::TypeFloat));
        for (int y = 0; y < 256; ++y)
            for (int x = 0; x < 512; ++x) {
                const bool sun = (x == 127 || x == 128) && (y == 63 || y == 64);
                const float rgb[3] { sun ? 2e4f : 1, sun ? 1e4f : 1, sun ? 5e3f : 1 };
                sky.setpixel(x, y, rgb);
            }
        EXPECT_TRUE(sky.write(path("sunny.exr"))) << sky.geterror();
        make_sky({ 1, 1, 1 }, "cloudy.exr", 512, 256);
        write("floor.obj",
              "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 1 0\n"
              "f 1/1/1 2/2/1 3/3/1 4/4/1\n");
        write("wall.obj", "v 1 0 9\nv 1 0 -9\nv 1 1 -9\nv 1 1 9\nf 1 2 3 4\n");
        write("hero.vismap",
              "mesh = \"floor.obj\"\noccluder = [\"wall.obj\"]\nresolution = 64\nsamples = 64\n"
              "reconstruct = \"off\"\n" // what is tested is the light of single texels
        );
    }

    // Of the middle row.
    float red(const std::string& name, int x) const { return pixels(name).values[3 * (32 * 64 + size_t(x))]; }
};

} // namespace

TEST_F(Suns, AShadowHasItsEdgeWhereTheSunPutsIt)
{
    EXPECT_THAT(done("makelightmap hero.vismap sunny.exr --suns auto -o lit.exr"), HasSubstr("suns: 1 sun with"));
    done("makelightmap hero.vismap sunny.exr -o soft.exr");
    // The wall is 1 high and the sun at 45 degrees: the shadow ends in the middle.
    const double flux = 2e4 * 4 * std::pow(M_PI / 256, 2) * std::sin(M_PI / 4) / M_PI, lit = flux * std::sin(M_PI / 4);
    EXPECT_LT(red("lit.exr", 35), 1.01f);
    EXPECT_LT(red("lit.exr", 60), 1.01f);
    EXPECT_NEAR(red("lit.exr", 28), 1 + lit, 0.2 + 0.01 * lit);
    EXPECT_NEAR(red("lit.exr", 3), 1 + lit, 0.2 + 0.01 * lit);
    EXPECT_GT(red("soft.exr", 35), 2);
    // The whole object turned: the wall is behind.
    done("makelightmap hero.vismap sunny.exr --suns auto --rotate 0,180,0 -o turned.exr");
    EXPECT_NEAR(red("turned.exr", 60), 0.5 + lit, 0.6 + 0.01 * lit);
}

TEST_F(Suns, AFileOfTheMapNeedsItsMeshAndGivesTheSameLight)
{
    done("makevismap hero.vismap -o vm.exr");
    done("makelightmap hero.vismap sunny.exr --suns auto --rotate 0,30,0 -o a.exr");
    done("makelightmap vm.exr sunny.exr --suns auto --rotate 0,30,0 --mesh floor.obj --occluder wall.obj -o b.exr");
    expect_same_pixels("a.exr", "b.exr", 0);
    refused(1, "does not store its mesh: set --mesh, and --occluder for each mesh that occluded it",
            "makelightmap vm.exr sunny.exr --suns on -o c.exr");
    refused(1, "not the mesh that",
            "makelightmap vm.exr sunny.exr --suns auto --mesh {spot} --occluder wall.obj -o c.exr");
    refused(1, "baked with other occluders: wall.obj; list the same ones",
            "makelightmap vm.exr sunny.exr --suns auto --mesh floor.obj -o c.exr");
    done("makevismap floor.obj --resolution 32 --samples 16 -o alone.exr");
    refused(1, "\"alone.exr\": baked without occluders; leave out --occluder",
            "makelightmap alone.exr sunny.exr --suns auto --mesh floor.obj --occluder wall.obj -o c.exr");
    refused(2, "set --suns auto", "makelightmap vm.exr sunny.exr --mesh floor.obj -o c.exr");
    refused(2, "the recipe of the visibility map",
            "makelightmap hero.vismap sunny.exr --suns auto --mesh floor.obj -o c.exr");
}

TEST_F(Suns, MeshesThatMoveHaveAFileForEachFrame)
{
    make_sky({ 0.5f, 0.5f, 0.5f }, "paint.exr", 8, 8);
    for (const char* frame : { "1", "2" }) {
        write(std::string("floor.") + frame + ".obj", read("floor.obj"));
        write(std::string("wall.") + frame + ".obj",
              std::string("v 1 0 9\nv 1 0 -9\nv 1 ") + frame + " -9\nv 1 " + frame + " 9\nf 1 2 3 4\n");
    }
    const std::string light = "makelightmap ", with = " sunny.exr --albedo paint.exr --suns on --bounce on ";
    done("makevismap floor.#.obj --occluder wall.#.obj --frames 1-2 --resolution 32 --samples 16 -o vm.#.exr");
    done(light + "vm.#.exr" + with + "--mesh floor.#.obj --occluder wall.#.obj --frames 1-2 -o lit.#.exr");
    for (const char* frame : { "1", "2" }) {
        const std::string file = std::string(".") + frame;
        done(light + "vm" + file + ".exr" + with + "--mesh floor" + file + ".obj --occluder wall" + file
             + ".obj -o one.exr");
        EXPECT_EQ(read("lit" + file + ".exr"), read("one.exr")) << frame;
    }
    EXPECT_NE(pixels("lit.1.exr").values, pixels("lit.2.exr").values);
    // One that stays is the same in all frames; and one map is not of two scenes.
    done(light + "vm.#.exr" + with + "--mesh floor.obj --occluder wall.#.obj --frames 1-2 -o stays.#.exr");
    expect_same_pixels("stays.2.exr", "lit.2.exr", 0);
    const std::string moving = " --occluder wall.#.obj --frames ";
    EXPECT_THAT(run(light + "vm.1.exr" + with + "--mesh floor.obj" + moving + "1-2 -o x.#.exr").all(),
                HasSubstr("\"vm.1.exr\": baked with other occluders: wall.1.obj; list"));
    refused(1, "\"wall.3.obj\": no such file",
            light + "vm.1.exr" + with + "--mesh floor.obj" + moving + "3 -o y.#.exr");
}

// A farm that lights whatever it gets does not stop, but says what the picture lacks.
TEST_F(Suns, AutoIsWhereTheMeshIsKnown)
{
    done("makevismap hero.vismap -o vm.exr");
    done("makelightmap vm.exr sunny.exr -o soft.exr");
    EXPECT_THAT(done("makelightmap vm.exr sunny.exr --suns auto -o same.exr"),
                HasSubstr("WARNING: suns stay in the environment, with soft shadows: \"vm.exr\" does not store its "
                          "mesh: set --mesh"));
    EXPECT_EQ(pixels("soft.exr").values, pixels("same.exr").values);
    EXPECT_THAT(attribute("same.exr", "vmlight:no_suns"), testing::StartsWith("\"vm.exr\" does not store"));
    EXPECT_EQ(attribute("soft.exr", "vmlight:no_suns"), "");
    done("makelightmap '" + path("vm.exr") + "' sunny.exr --suns auto -o same.exr");
    EXPECT_THAT(attribute("same.exr", "vmlight:no_suns"), testing::StartsWith("\"vm.exr\" does not store"));
    // A light that was filtered before has them or not, whatever the mesh.
    done("makecfem sunny.exr --stack -o whole.exr");
    done("makelightmap vm.exr whole.exr --suns auto -o same.exr");
    EXPECT_EQ(pixels("soft.exr").values, pixels("same.exr").values);
    done("makecfem sunny.exr --stack --suns auto -o rest.exr");
    refused(1, "does not store its mesh: set --mesh, and --occluder for each mesh that occluded it",
            "makelightmap vm.exr rest.exr --suns auto -o c.exr");
    done("makelightmap hero.vismap sunny.exr --suns auto -o a.exr");
    EXPECT_THAT(done("makelightmap hero.vismap sunny.exr --suns on -o b.exr"),
                HasSubstr("model: lobe+suns, the best that"));
    EXPECT_EQ(pixels("a.exr").values, pixels("b.exr").values);
    EXPECT_THAT(done("makelightmap hero.vismap cloudy.exr --suns on -o c.exr"), Not(HasSubstr("lobe+suns")));
}

TEST_F(Suns, AreARowOfTheEffects)
{
    const std::string line = "makelightmap hero.vismap sunny.exr -o a.exr --explain";
    EXPECT_THAT(done(line), HasSubstr("not asked for: --suns auto adds them"));
    EXPECT_THAT(
        done(line + " --suns auto"),
        testing::AllOf(HasSubstr("1 sun with 28 % of the light"), testing::ContainsRegex("  suns: 0.0[0-9]+ M rays")));
    EXPECT_THAT(done("makelightmap hero.vismap cloudy.exr --suns auto --explain -o a.exr"),
                HasSubstr("the light has no small strong source"));
    done("makelightmap hero.vismap sunny.exr -o soft.exr");
    EXPECT_THAT(done(line + " --suns auto --effects -suns"),
                HasSubstr("WARNING: --effects: the picture has suns, left out"));
    EXPECT_EQ(pixels("a.exr").values, pixels("soft.exr").values);
    EXPECT_THAT(done("makelightmap hero.vismap cloudy.exr --suns auto --effects -suns -o a.exr"),
                Not(HasSubstr("WARNING")));
    done("makelightmap hero.vismap sunny.exr --suns auto -o hard.exr");
    done("makelightmap hero.vismap sunny.exr --effects +suns -o a.exr");
    EXPECT_EQ(pixels("a.exr").values, pixels("hard.exr").values);
    done("makevismap hero.vismap -o vm.exr");
    done("makelightmap vm.exr sunny.exr --effects +suns --mesh floor.obj --occluder wall.obj -o a.exr");
    EXPECT_EQ(pixels("a.exr").values, pixels("hard.exr").values);
    EXPECT_THAT(done("makelightmap vm.exr sunny.exr --suns auto --explain -o a.exr"), HasSubstr("set --mesh"));
    refused(1, "does not store its mesh: set --mesh, and --occluder for each mesh that occluded it",
            "makelightmap vm.exr sunny.exr --effects +suns -o a.exr");
}

// Of what frames keep, makelightmap makes the same light.
TEST_F(Suns, FramesHaveThem)
{
    const std::string size = " --size 32 --spp 4 --resolution 64 --samples 16 --cfem-resolution 32";
    const std::string line = "vmframes floor.obj sunny.exr --object wall.obj --white --bounce auto" + size;
    const std::string text = done(line + " --suns on --explain --keep kept -o a.exr");
    EXPECT_THAT(text, HasSubstr("suns: 1 sun with"));
    EXPECT_THAT(text, HasSubstr("effects: floor.obj:"));
    EXPECT_THAT(text, HasSubstr("1 sun with"));
    write("frame.vismap", "mesh = \"floor.obj\"\noccluder = [\"wall.obj\"]\nresolution = 64\nsamples = 16\n");
    done("makelightmap frame.vismap sunny.exr --suns on -o b.exr --cfem-resolution 32");
    done("vmframes floor.obj sunny.exr --object wall.obj --white --suns on --keep plain -o c.exr" + size);
    expect_same_pixels("plain/floor_lightmap.exr", "b.exr", 1e-4f);
    EXPECT_GT(pixels("kept/floor_lightmap.exr").values[3 * (32 * 64 + 60)], red("b.exr", 60));
    // Frames that are all lit by one trace of the bounce; what they show is the test of FrameLight.
    done(line + " --suns auto --frames 1-2 --turntable -o 'd.#.exr'");
    expect_finite("d.1.exr");
    expect_finite("d.2.exr");
    // A split sky serves with its suns; and shadows on a ground show them.
    done("makecfem sunny.exr --suns auto --stack --resolution 32 -o split.exr");
    done("vmframes floor.obj split.exr --object wall.obj --white --suns on --keep split -o f.exr --size 32 --spp 4 "
         "--resolution 64 --samples 16");
    expect_same_pixels("split/floor_lightmap.exr", "b.exr", 1e-3f);
    done("vmframes wall.obj sunny.exr --ground shadow --suns auto -o shadow.exr" + size);
    expect_finite("shadow.exr");
    // A map with a normal map leaves them in the sky, or is refused.
    OIIO::ImageBuf flat(OIIO::ImageSpec(4, 4, 3, OIIO::TypeFloat));
    for (OIIO::ImageBuf::Iterator<float> p(flat); !p.done(); ++p)
        p[0] = 0.7f, p[1] = 0.5f, p[2] = 0.9f;
    ASSERT_TRUE(flat.write(path("bumps.exr")));
    done("makevismap floor.obj --resolution 64 --samples 16 --normal-map bumps.exr -o bumpy.exr");
    const std::string bumpy = "vmframes floor.obj sunny.exr --vismap bumpy.exr --size 16 -o g.exr ";
    EXPECT_THAT(done(bumpy + "--suns auto"), HasSubstr("suns stay in the environment, with soft shadows"));
    refused(1, "\"bumpy.exr\": the visibility map was baked with a normal map", bumpy + "--suns on");
}

TEST_F(Suns, AFilteredSkyCarriesThemInItsMetadata)
{
    for (const char* model : { "paper", "lobe" }) {
        const std::string flags = std::string(" --model ") + model;
        done(std::string("makecfem sunny.exr --suns auto -o cfem.exr") + (model[0] == 'l' ? " --stack" : ""));
        EXPECT_THAT(attribute("cfem.exr", "vmlight:suns"), HasSubstr("0.7"));
        done("makelightmap hero.vismap sunny.exr --suns auto -o a.exr" + flags);
        done("makelightmap hero.vismap cfem.exr --suns auto -o b.exr" + flags);
        expect_same_pixels("a.exr", "b.exr", 0);
        EXPECT_EQ(attribute("b.exr", "vmlight:cfem_suns"), attribute("cfem.exr", "vmlight:suns"));
        refused(1, "its suns were split off", "makelightmap hero.vismap cfem.exr -o c.exr" + flags);
    }
}

TEST_F(Suns, WhereThereAreNoneNothingChanges)
{
    done("makecfem cloudy.exr --stack -o a.exr");
    EXPECT_THAT(done("makecfem cloudy.exr --stack --suns auto -o b.exr"), HasSubstr("suns: none"));
    EXPECT_EQ(read("a.exr"), read("b.exr"));
    done("makelightmap hero.vismap cloudy.exr -o lit.exr");
    done("makelightmap hero.vismap cloudy.exr --suns auto -o same.exr");
    EXPECT_EQ(read("lit.exr"), read("same.exr"));
}

TEST_F(Suns, EveryModelAddsThemAndSoDoAlbedoAndExposure)
{
    done("makelightmap hero.vismap sunny.exr --suns auto -o plain.exr");
    make_sky({ 0.5f, 0.25f, 1 }, "albedo.exr", 64, 64);
    done("makelightmap hero.vismap sunny.exr --suns auto --albedo albedo.exr --exposure 1 -o lit.exr");
    const Pixels plain = pixels("plain.exr"), lit = pixels("lit.exr");
    for (size_t i = 0; i < plain.values.size(); i += 3) {
        ASSERT_NEAR(lit.values[i], plain.values[i], 1e-5f * plain.values[i]);
        ASSERT_NEAR(lit.values[i + 1], 0.5f * plain.values[i + 1], 1e-5f * plain.values[i]);
    }
    for (const char* basis : { "sh", "mask", "cells" }) {
        done(std::string("makevismap hero.vismap --basis ") + basis + " -o vm.exr");
        done("makelightmap vm.exr sunny.exr --suns auto --mesh floor.obj --occluder wall.obj -o model.exr");
        for (const int x : { 3, 10, 20, 40, 50, 60 })
            EXPECT_NEAR(red("model.exr", x), red("plain.exr", x), 0.3) << basis << " " << x;
    }
}

TEST_F(Suns, ARecipeKeepsThemAndFramesShareTheMesh)
{
    done("makelightmap hero.vismap sunny.exr --suns auto --rotate 0,20,0 -o hero.lightmap");
    EXPECT_THAT(read("hero.lightmap"), HasSubstr("suns = \"auto\""));
    done("makelightmap hero.lightmap -o a.exr");
    done("makelightmap hero.vismap sunny.exr --suns auto --frames 1-3 --rotate-y 10:30 -o f.#.exr");
    expect_same_pixels("a.exr", "f.2.exr", 1e-6f);
}

TEST_F(Suns, AMapCanStoreWhatItSeesOfThem)
{
    done("makevismap hero.vismap --sun-directions 1,1,0,0.8;0,1,0 -o vm.exr");
    EXPECT_THAT(channel_names("vm.exr"), testing::IsSupersetOf({ "sun.0", "sun.1" }));
    done("makelightmap hero.vismap sunny.exr --suns auto -o traced.exr");
    EXPECT_THAT(done("makelightmap vm.exr sunny.exr --suns auto -o lit.exr"),
                HasSubstr("suns: from the visibility map"));
    EXPECT_THAT(done("makelightmap vm.exr sunny.exr --suns auto --explain -o lit.exr"),
                HasSubstr("the map stores what texels see of them, and no ray is traced"));
    EXPECT_THAT(done("makelightmap hero.vismap sunny.exr --suns auto --explain -o traced.exr"),
                HasSubstr("one ray or more for each texel that faces them"));
    for (const int x : { 3, 10, 20, 28, 36, 50, 60 })
        EXPECT_NEAR(red("lit.exr", x), red("traced.exr", x), 0.1 + 0.02 * red("traced.exr", x)) << x;
    refused(1, "the suns are not among those", "makelightmap vm.exr sunny.exr --suns auto --rotate 0,20,0 -o c.exr");
    EXPECT_THAT(
        done("makelightmap vm.exr sunny.exr --suns auto --rotate 0,20,0 --mesh floor.obj --occluder wall.obj -o c.exr"),
        HasSubstr("rays in"));
    refused(1, "is not a sun", "makevismap hero.vismap --sun-directions 0,0,0 -o d.exr");
    done("makevismap hero.vismap -o plain.exr");
    EXPECT_EQ(visibility("plain.exr").values, visibility("vm.exr").values);
    EXPECT_EQ(attribute("plain.exr", "vmlight:sun_directions"), "");
}

// The switches of a lamp on black, of tiles, and of light that is grey.
TEST_F(Suns, AreExplainedOfAllLight)
{
    OIIO::ImageBuf lamp(OIIO::ImageSpec(512, 256, 3, OIIO::TypeFloat));
    for (int y = 60; y < 64; ++y)
        for (int x = 100; x < 104; ++x) {
            const float rgb[3] { 2e4f, 1e4f, 5e3f };
            lamp.setpixel(x, y, rgb);
        }
    ASSERT_TRUE(lamp.write("lamp.exr")) << lamp.geterror();
    EXPECT_THAT(done("makelightmap hero.vismap lamp.exr --suns auto --explain -o a.exr"),
                HasSubstr("without its suns the environment is of one colour"));
    done("makevismap hero.vismap -o vm.exr");
    OIIO::ImageBuf grey(OIIO::ImageSpec(16, 8, 1, OIIO::TypeFloat));
    grey.specmod().channelnames = { "Y" };
    const float one = 1;
    for (int i = 0; i < 16 * 8; ++i)
        grey.setpixel(i % 16, i / 16, &one);
    ASSERT_TRUE(grey.write("grey.exr")) << grey.geterror();
    done("makelightmap vm.exr grey.exr --is-cfem --model paper --suns auto --explain -o a.exr");
    done("makevismap hero.vismap --udim 1001 -o 'v.<UDIM>.exr'");
    EXPECT_THAT(done("makelightmap 'v.<UDIM>.exr' sunny.exr --suns auto --mesh floor.obj --occluder wall.obj --effects "
                     "-suns -o 'l.<UDIM>.exr'"),
                HasSubstr("effects: the picture has suns, left out"));
}
