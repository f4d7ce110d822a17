// SPDX-License-Identifier: Apache-2.0
// --explain, --dry-run and --effects of makelightmap.
#include "command_test.h"

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
    EXPECT_THAT(said, ContainsRegex("rotation +off .* one that turns nothing"));
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
                HasSubstr("makelightmap WARNING: effects: the picture has albedo, left out: light is off by about "
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
    refused(1, "effects: +albedo is impossible: no --albedo is given", command + "--effects +albedo");
    refused(1, "effects: -filter: cannot be left out", command + "--effects -filter");
    refused(2, "effects: \"filtre\" is not an effect: did you mean \"filter\"?", command + "--effects +filtre");
    done("makecfem sky.exr -o cfem.exr");
    refused(1, "effects: +filter is impossible: the light is filtered already",
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
    EXPECT_EQ(names("a").size(), 0u);
    refused(2, "--dry-run cannot be saved in a recipe",
            "makelightmap vm.exr sky.exr -o x.exr --dry-run --print-recipe");
    write("quad.vismap", "mesh = \"quad.obj\"\n");
    refused(
        2, "--dry-run: \"quad.vismap\" is a recipe, whose map would have to be baked: makevismap quad.vismap --dry-run",
        "makelightmap quad.vismap sky.exr -o x.exr --dry-run");
}
