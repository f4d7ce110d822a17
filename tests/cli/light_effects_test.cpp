// SPDX-License-Identifier: Apache-2.0
// --explain, --dry-run and --effects of makelightmap.
#include "command_test.h"

#include <vmlight/base/work_counts.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/stage/open_source.h>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

using namespace vmlight;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

namespace {

class LightEffects : public CommandTest
{
protected:
    void SetUp() override
    {
        make_vismap(); // of an open quad
        make_sky({ 0.25f, 0.5f, 2 });
        make_albedo("half_lin_rec709.exr", 0.5f);
        make_albedo("one_lin_rec709.exr", 1);
    }
    static void make_albedo(const std::string& name, float value)
    {
        OIIO::ImageBuf image(OIIO::ImageSpec(8, 8, 3, OIIO::TypeFloat));
        OIIO::ImageBufAlgo::fill(image, { value, value, value });
        ASSERT_TRUE(image.write(name)) << image.geterror();
    }
    std::string light(const std::string& flags) const { return done("makelightmap vm.exr " + flags); }
    bool same_bytes(const std::string& a, const std::string& b) const { return read(a) == read(b); }
};

} // namespace

TEST_F(LightEffects, ExplainSaysWhatIsCalledForAndWhatItTook)
{
    const std::string said = light("{sky} -o a.exr --explain --albedo half_lin_rec709.exr --rotate 0,90,0");
    EXPECT_THAT(said, ContainsRegex("filter +on .* an environment is given"));
    EXPECT_THAT(said, ContainsRegex("stack-levels +on .* the model lobe reads 9 images of the light"));
    EXPECT_THAT(said, ContainsRegex("rotation +on .* the light is turned by 90 degrees"));
    EXPECT_THAT(said, ContainsRegex("albedo +on .* values from 0.5 to 0.5"));
    EXPECT_THAT(said, ContainsRegex("visibility +off .* V is 1 in all of [0-9]+ texels"));
    EXPECT_THAT(said,
                ContainsRegex("took: [1-9][0-9]* passes of filters over the environment; 0.[0-9]*[1-9][0-9]* M "
                              "texels looked light up, 0.[0-9]*[1-9]"));
    EXPECT_LT(said.find("effects:"), said.find("took:"));
    EXPECT_THAT(light("{sky} -o a.exr"), Not(HasSubstr("effects")));
}

TEST_F(LightEffects, WhatChangesNothingIsOffAndCostsNothing)
{
    const std::string said = light("sky.exr -o a.exr --explain --albedo one_lin_rec709.exr --rotate 0,0,0");
    EXPECT_THAT(said, ContainsRegex("filter +off .* the environment is of one colour"));
    EXPECT_THAT(said, ContainsRegex("stack-levels +off "));
    EXPECT_THAT(said, ContainsRegex("rotation +off .* one by 0 degrees"));
    EXPECT_THAT(said, ContainsRegex("albedo +off .* it is 1 everywhere"));
    EXPECT_THAT(said, ContainsRegex("color-conversion +off "));
    EXPECT_THAT(said,
                HasSubstr("took: 0 passes of filters over the environment; 0.000 M texels looked light up, 0.000 M "
                          "were multiplied by an albedo; 0.000 M pixels changed their colour space"));
    EXPECT_THAT(said, HasSubstr(": of one colour, which stays as it is"));
    light("sky.exr -o b.exr");
    expect_same_pixels("a.exr", "b.exr", 0);
    // By every model, and whatever the filter.
    for (const char* flags : { "--model paper", "--model lobe", "--cfem-filter sh", "--effects all" }) {
        light(std::string("sky.exr -o b.exr ") + flags);
        expect_same_pixels("a.exr", "b.exr", 0);
    }
}

TEST_F(LightEffects, AutoAndAllAreTheSameFile)
{
    for (const char* inputs :
         { "sky.exr --albedo one_lin_rec709.exr", "{sky} --albedo half_lin_rec709.exr --rotate 10,20,30" }) {
        const std::string flags = std::string(inputs) + " -o ";
        light(flags + "auto.exr");
        light(flags + "explained.exr --explain");
        light(flags + "all.exr --effects all");
        EXPECT_TRUE(same_bytes("auto.exr", "explained.exr"));
        EXPECT_TRUE(same_bytes("auto.exr", "all.exr"));
    }
    EXPECT_THAT(light("sky.exr -o a.exr --effects all --explain"),
                AllOf(ContainsRegex("filter +forced on"), Not(HasSubstr("took: 0 passes"))));
}

TEST_F(LightEffects, WhatIsSwitchedOffIsGoneAndSaidToBe)
{
    // Open texels under a sky of mean .25, .5, 2: half the albedo is off by sqrt(mean of squares) / 2.
    const std::string said = light("sky.exr -o off.exr --albedo half_lin_rec709.exr --effects -albedo");
    EXPECT_THAT(said,
                HasSubstr("makelightmap WARNING: --effects: the picture has albedo, left out: light is off by about "
                          "0.6 (RMS), and its mean is 0.46"));
    light("sky.exr -o without.exr");
    expect_same_pixels("off.exr", "without.exr", 0);
    EXPECT_THAT(light("{sky} -o off.exr --rotate 0,90,0 --effects -rotation"),
                ContainsRegex("the picture has rotation, left out: light is off by about [0-9.e-]+ \\(RMS\\)"));
    light("{sky} -o without.exr");
    expect_same_pixels("off.exr", "without.exr", 0);
    EXPECT_THAT(light("sky.exr -o a.exr --albedo one_lin_rec709.exr --effects -albedo"), Not(HasSubstr("WARNING")));
    EXPECT_THAT(light("sky.exr -o a.exr --effects -albedo,-rotation"), Not(HasSubstr("WARNING")));
}

TEST_F(LightEffects, TheImpossibleIsRefused)
{
    const std::string command = "makelightmap vm.exr sky.exr -o x.exr ";
    refused(2, "effects: +albedo is impossible: no --albedo is given", command + "--effects +albedo");
    refused(1, "effects: -filter: cannot be left out", "makelightmap vm.exr {sky} -o x.exr --effects -filter");
    refused(2, "effects: \"filtre\" is not an effect: did you mean \"filter\"?", command + "--effects +filtre");
    done("makecfem sky.exr -o cfem.exr");
    refused(2, "effects: +filter is impossible: the light is filtered already",
            "makelightmap vm.exr cfem.exr -o x.exr --effects +filter");
}

TEST_F(LightEffects, ADryRunWritesNothing)
{
    const std::string said = light("{sky} -o a.exr --dry-run");
    EXPECT_THAT(said, HasSubstr("effects:"));
    EXPECT_THAT(said,
                ContainsRegex("expected: [0-9.]+ s: start [0-9.]+ s, read and filter [0-9.]+ s, light [0-9.]+ s, "
                              "1 file [0-9.]+ s; [1-9][0-9]* MB of memory"));
    EXPECT_FALSE(exists("a.exr"));
    EXPECT_THAT(light("{sky} -o a.####.exr --frames 1-48 --rotate-y 0:360 --dry-run"), HasSubstr("48 files"));
    // What each frame has of its own is read for two: their environment is filtered twice, else once.
    for (const char* number : { "1", "2" }) {
        make_albedo(std::string("albedo_lin_rec709.") + number + ".exr", 0.5f);
        make_sky({ 1, 2, 3 }, std::string("night.") + number + ".exr");
        OIIO::ImageBuf night(std::string("night.") + number + ".exr");
        OIIO::ImageBufAlgo::fill(night, { 9.0f, 9.0f, 9.0f }, OIIO::ROI(0, 3, 0, 3));
        ASSERT_TRUE(night.write(std::string("night.") + number + ".exr"));
    }
    const auto passes = [&](const std::string& flags) {
        const int64_t before = work_counts().filter_passes;
        light(flags + " --model paper --frames 1-2 -o a.####.exr --dry-run");
        return work_counts().filter_passes - before;
    };
    EXPECT_EQ(passes("night.1.exr --albedo albedo_lin_rec709.#.exr"), 1);
    EXPECT_EQ(passes("night.#.exr"), 2);
    EXPECT_EQ(names("a.").size(), 0u);
    refused(2, "--dry-run cannot be saved in a recipe",
            "makelightmap vm.exr sky.exr -o x.exr --dry-run --print-recipe");
    write("quad.vismap", "mesh = \"quad.obj\"\n");
    refused(
        2, "--dry-run: \"quad.vismap\" is a recipe, whose map would have to be baked: makevismap quad.vismap --dry-run",
        "makelightmap quad.vismap sky.exr -o x.exr --dry-run");
}

TEST_F(LightEffects, ADryRunNeedsNoOutput)
{
    EXPECT_THAT(light("{sky} --dry-run"), ContainsRegex("effects:(.|\n)*expected: "));
    EXPECT_THAT(light("{sky} --frames 1-48 --rotate-y 0:360 --dry-run"), HasSubstr("48 files"));
    EXPECT_EQ(names("").size(), 5u) << "nothing is written";
    refused(2, "-o OUTPUT.exr is missing", "makelightmap vm.exr sky.exr --explain");
    refused(2, "--explain cannot be saved in a recipe",
            "makelightmap vm.exr sky.exr -o x.exr --explain --print-recipe");
}

TEST_F(LightEffects, QuietPrintsWhatIsAskedFor)
{
    const std::string said = light("{sky} -o a.exr --explain --quiet");
    EXPECT_THAT(said, AllOf(HasSubstr("effects:"), HasSubstr("took: "), Not(HasSubstr("light: "))));
    EXPECT_THAT(light("{sky} --dry-run --quiet"), AllOf(HasSubstr("effects:"), HasSubstr("expected: ")));
    EXPECT_EQ(light("{sky} -o a.exr --quiet"), "");
}

TEST_F(LightEffects, ConversionsOfAllInputsAreSeen)
{
    const auto make = [](const std::string& name, OIIO::TypeDesc type) {
        OIIO::ImageBuf image(OIIO::ImageSpec(8, 4, 3, type));
        OIIO::ImageBufAlgo::fill(image, { 0.5f, 0.5f, 0.5f });
        ASSERT_TRUE(image.write(name)) << image.geterror();
    };
    make("texture.png", OIIO::TypeUInt8);
    make("sky_8bit.png", OIIO::TypeUInt8);
    const std::string by_albedo = light("sky.exr -o a.exr --explain --albedo texture.png");
    EXPECT_THAT(by_albedo, ContainsRegex("color-conversion +on .* albedo: srgb_rec709_scene -> lin_rec709_scene"));
    EXPECT_THAT(light("sky_8bit.png -o a.exr --explain"),
                ContainsRegex("color-conversion +on .* environment: srgb_rec709_scene -> "));
    EXPECT_THAT(light("sky.exr -o a.exr --explain --output-colorspace lin_ap1_scene"),
                ContainsRegex("color-conversion +on .* result: lin_ap1_scene"));
    refused(1, "effects: -color-conversion: cannot be left out",
            "makelightmap vm.exr sky.exr -o x.exr --albedo texture.png --effects -color-conversion");
    light("sky.exr -o a.exr --albedo half_lin_rec709.exr --effects -color-conversion");
}

TEST_F(LightEffects, ContradictionsAreRefused)
{
    const std::string command = "makelightmap vm.exr sky.exr -o x.exr --mesh quad.obj ";
    refused(2, "effects: -suns contradicts suns = on", command + "--suns on --effects -suns");
    refused(2, "effects: -bounce contradicts bounce = on",
            command + "--albedo half_lin_rec709.exr --bounce on --effects auto,-bounce");
    done(command + "--suns auto --effects -suns"); // what the suns add
}

// What is switched on stays on in the light that the picture is compared with.
TEST_F(LightEffects, SwitchedOnIsAskedForAlsoWhereSomethingElseIsSwitchedOff)
{
    done("makecfem " + std::string(VMLIGHT_TEST_DATA) + "/kloppenheim_05.hdr --suns auto --stack -o stack.exr");
    const auto warning = [&](const std::string& flags) {
        const std::string said
            = light("stack.exr --mesh quad.obj --albedo half_lin_rec709.exr -o a.exr " + flags + " --quiet");
        return said.substr(std::min(said.find("WARNING: --effects"), said.size()));
    };
    const std::string by_flag = warning("--suns on --effects -albedo");
    EXPECT_THAT(by_flag, HasSubstr("the picture has albedo, left out"));
    EXPECT_EQ(warning("--effects +suns,-albedo"), by_flag);
    EXPECT_EQ(warning("--effects all,-albedo --suns on"), by_flag);
}

// Of an animation, the first frame alone is lit both ways.
TEST_F(LightEffects, AnAnimationIsComparedOnce)
{
    const std::string flags
        = "{sky} --albedo half_lin_rec709.exr --effects -albedo --frames 1-4 --rotate-y 0:90 -o a.####.exr";
    EXPECT_EQ(count(light(flags), "WARNING: --effects"), 1u);
    EXPECT_EQ(names("a.").size(), 4u);
}

TEST_F(LightEffects, WhatIsSwitchedOffIsInTheMetadata)
{
    light("sky.exr -o off.exr --albedo half_lin_rec709.exr --effects -rotation,-albedo");
    EXPECT_EQ(attribute("off.exr", "vmlight:effects"), "-rotation,-albedo");
    light("sky.exr -o all.exr --effects all");
    EXPECT_EQ(attribute("all.exr", "vmlight:effects"), "");
    write("off.lightmap",
          "vismap = \"vm.exr\"\nenvironment = \"sky.exr\"\nalbedo = \"half_lin_rec709.exr\"\n"
          "effects = \"-rotation,-albedo\"\n");
    OIIO::ImageBuf made;
    LightmapRecipe recipe;
    std::string error;
    ASSERT_TRUE(read_recipe(recipe, "off.lightmap", error)) << error;
    const PixelSourcePointer source = open_source(recipe, error, {}, Sharing::none);
    ASSERT_TRUE(source) << error;
    EXPECT_EQ(source->spec().get_string_attribute("vmlight:effects"), "-rotation,-albedo");
    ASSERT_TRUE(make_image(made, recipe)) << made.geterror();
    EXPECT_EQ(made.spec().get_string_attribute("vmlight:effects"), "-rotation,-albedo");
}

TEST_F(LightEffects, ARecipeIsRefusedByWhoeverOpensIt)
{
    OIIO::ImageBuf sky(kSky);
    ASSERT_TRUE(sky.write("studio.exr")) << sky.geterror();
    const auto fault = [&](const std::string& effects, bool whole) {
        write("x.lightmap", "vismap = \"vm.exr\"\nenvironment = \"studio.exr\"\neffects = \"" + effects + "\"\n");
        LightmapRecipe recipe;
        std::string error;
        EXPECT_TRUE(read_recipe(recipe, "x.lightmap", error)) << error;
        if (!whole) {
            const PixelSourcePointer source = open_source(recipe, error, {}, Sharing::none);
            std::vector<float> pixels(8 * 8 * 3);
            if (source)
                source->read({ 0, 8, 0, 8 }, pixels.data(), error);
            return error;
        }
        OIIO::ImageBuf made;
        return make_image(made, recipe) ? std::string() : made.geterror();
    };
    for (const bool whole : { false, true }) {
        EXPECT_THAT(fault("+albedo", whole), HasSubstr("+albedo is impossible: no --albedo is given"));
        EXPECT_THAT(fault("-filter", whole), HasSubstr("-filter: cannot be left out: an environment is given"));
        EXPECT_THAT(fault("-stack-levels", whole), HasSubstr("-stack-levels: cannot be left out"));
        EXPECT_EQ(fault("-rotation,-visibility", whole), "");
    }
}

TEST_F(LightEffects, AlbedosAreJudgedByTheirColours)
{
    const auto make = [](const std::string& name, float value, float alpha, OIIO::ROI full) {
        OIIO::ImageSpec spec(8, 8, 4, OIIO::TypeFloat);
        OIIO::set_roi_full(spec, full);
        OIIO::ImageBuf image(spec);
        OIIO::ImageBufAlgo::fill(image, { value, value, value, alpha });
        ASSERT_TRUE(image.write(name)) << image.geterror();
    };
    const OIIO::ROI own(0, 8, 0, 8), wider(0, 16, 0, 8);
    make("alpha_lin_rec709.exr", 1, 0.5f, own);
    EXPECT_THAT(light("sky.exr -o a.exr --explain --albedo alpha_lin_rec709.exr"),
                ContainsRegex("albedo +off .* it is 1 everywhere"));
    make("part_lin_rec709.exr", 1, 1, wider); // black where there is no pixel
    EXPECT_THAT(light("sky.exr -o a.exr --explain --albedo part_lin_rec709.exr"),
                ContainsRegex("albedo +on .* values from 0 to 1"));
    make("black_lin_rec709.exr", 0, 1, own);
    EXPECT_THAT(light("sky.exr -o a.exr --explain --albedo black_lin_rec709.exr"),
                ContainsRegex("albedo +on .* values from 0 to 0"));
}

TEST_F(LightEffects, OneSwitchForcesOneThing)
{
    const std::string line = "sky.exr -o a.exr --explain --albedo one_lin_rec709.exr --effects ";
    const std::string by_albedo = light(line + "+albedo"), by_levels = light(line + "+stack-levels");
    EXPECT_THAT(by_albedo, ContainsRegex("0.000 M texels looked light up, 0.[0-9]*[1-9][0-9]* M were multiplied"));
    EXPECT_THAT(by_levels, ContainsRegex("0.[0-9]*[1-9][0-9]* M texels looked light up, 0.000 M were multiplied"));
    EXPECT_THAT(light("sky.exr -o a.exr --explain --effects +rotation"), ContainsRegex("rotation +off "));
}
