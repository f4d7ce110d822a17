// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cfem/cfem.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/stage/recipe/recipe.h>

#include <gtest/gtest.h>

using namespace vmlight;

namespace {

std::string param_refusal(const char* name, const char* text)
{
    CfemParams params;
    std::string error;
    EXPECT_FALSE(set_param(params, name, text, error)) << name << " = " << text;
    return error;
}

} // namespace

TEST(Params, AWholeTextMustBeTheValue)
{
    EXPECT_EQ(param_refusal("order", "3x"), "order: \"3x\" is not a whole number");
    EXPECT_EQ(param_refusal("order", ""), "order: \"\" is not a whole number");
    EXPECT_EQ(param_refusal("order", "2.5"), "order: \"2.5\" is not a whole number");
    EXPECT_EQ(param_refusal("order", "nan"), "order: \"nan\" is not a whole number");
    EXPECT_EQ(param_refusal("order", "0x10"), "order: \"0x10\" is not a whole number");
    EXPECT_EQ(param_refusal("order", "0"), "order: 0 is not in [1, 64]");
    EXPECT_EQ(param_refusal("order", "1e30"), "order: 1e30 is not in [1, 64]");
    EXPECT_EQ(param_refusal("filter", "Exact"), "filter: \"Exact\" is not one of exact, sh");
}

TEST(Params, AnUnknownNameIsRefusedWithTheNearest)
{
    EXPECT_EQ(param_refusal("filtre", "sh"), "unknown parameter \"filtre\"; did you mean \"filter\"?");
    EXPECT_EQ(param_refusal("quaternionic", "1"), "unknown parameter \"quaternionic\"");
}

TEST(Params, ListsTakeTheirCountOrNothing)
{
    LightmapParams params;
    std::string error;
    ASSERT_TRUE(set_param(params, "rotate", "0, 90,-1.5e1", error)) << error;
    EXPECT_EQ(params.rotate, (std::vector<double> { 0, 90, -15 }));
    EXPECT_FALSE(set_param(params, "rotate", "1,2", error));
    EXPECT_EQ(error, "rotate: \"1,2\" has 2 numbers, expected 3");
    EXPECT_FALSE(set_param(params, "rotate", "1,b,3", error));
    EXPECT_EQ(error, "rotate: \"b\" in \"1,b,3\" is not a number");
    EXPECT_EQ(params.rotate, (std::vector<double> { 0, 90, -15 }));
    ASSERT_TRUE(set_param(params, "rotate", "", error));
    EXPECT_TRUE(params.rotate.empty());
}

TEST(Params, ASizeIsTwoNumbersOrTheWidthAlone)
{
    CfemParams params;
    std::string error;
    ASSERT_TRUE(set_param(params, "resolution", "64", error)) << error;
    EXPECT_EQ(params.resolution.height, 32);
    ASSERT_TRUE(set_param(params, "resolution", "1", error)) << error;
    EXPECT_EQ(params.resolution.height, 1);
    ASSERT_TRUE(set_param(params, "resolution", "7x9", error)) << error;
    EXPECT_EQ(params.resolution.width, 7);
    EXPECT_EQ(params.resolution.height, 9);
    for (const char* text : { "", "x", "7x", "x9", "7x9x2", "-7x9", "7 by 9", "1e9x1" })
        param_refusal("resolution", text);
}

TEST(Params, MetadataReadsBackToTheSameParams)
{
    LightmapParams params;
    params.exposure = 1.0 / 3;
    params.rotate = { 0.1, 90, -7e-9 };
    OIIO::ImageSpec spec;
    append_params(spec, params);
    LightmapParams back;
    std::string error;
    for (const std::string& name : param_names(params))
        ASSERT_TRUE(set_param(back, name, spec.get_string_attribute("vmlight:" + name), error)) << error;
    EXPECT_EQ(back.exposure, params.exposure);
    EXPECT_EQ(back.rotate, params.rotate);
}

TEST(Params, ValuesSetInCodeAreCheckedToo)
{
    CfemParams params;
    std::string error;
    EXPECT_TRUE(check_params(params, error)) << error;
    params.resolution.width = 0;
    EXPECT_FALSE(check_params(params, error));
    EXPECT_EQ(error, "resolution: \"0x64\" is not WIDTH or WIDTHxHEIGHT in pixels, each from 1 to 16384");
}

TEST(Params, WordsAreSomeOfThoseAllowedInTheirOrder)
{
    VismapParams params;
    std::string error;
    ASSERT_TRUE(set_param(params, "channels", "coverage, normal", error)) << error;
    EXPECT_EQ(params.channels, (std::vector<std::string> { "normal", "coverage" }));
    EXPECT_TRUE(params.has("normal"));
    EXPECT_EQ(value_text({ "coverage", "normal" }, ChoiceSet { { { "normal", "" }, { "coverage", "" } } }),
              "normal,coverage");
    EXPECT_FALSE(set_param(params, "channels", "normal,covrage", error));
    EXPECT_EQ(error, "channels: \"covrage\" is not one of normal, coverage, error; did you mean \"coverage\"?");
    EXPECT_FALSE(set_param(params, "channels", "normal,coverage,normal", error));
    EXPECT_EQ(error, "channels: \"normal\" is given twice");
    EXPECT_FALSE(set_param(params, "channels", "normal,", error));
    EXPECT_EQ(error, "channels: \"\" is not one of normal, coverage, error");
    EXPECT_EQ(params.channels.size(), 2u);
    ASSERT_TRUE(set_param(params, "channels", "", error)) << error;
    EXPECT_TRUE(params.channels.empty());
    EXPECT_FALSE(params.has("normal"));
    EXPECT_EQ(allowed_text(ChoiceSet { { { "normal", "" }, { "coverage", "" } } }), "normal,coverage");
}

TEST(Params, ListsOfNamesAreOneALine)
{
    VismapRecipe recipe;
    std::string error;
    ASSERT_TRUE(set_param(recipe, "occluder", "a, b.obj\nc;d.obj", error)) << error;
    EXPECT_EQ(recipe.occluder, (std::vector<std::string> { "a, b.obj", "c;d.obj" }));
    EXPECT_EQ(value_text(recipe.occluder, Paths {}), "a, b.obj\nc;d.obj");
    EXPECT_FALSE(set_param(recipe, "occluder", "a\n\nb", error));
    EXPECT_EQ(error, "occluder: one of the names is empty");
    EXPECT_EQ(recipe.occluder.size(), 2u);
    ASSERT_TRUE(set_param(recipe, "occluder", "", error)) << error;
    EXPECT_TRUE(recipe.occluder.empty());
    EXPECT_FALSE(set_param(recipe, "mesh", OIIO::string_view("a\0b", 3), error));
    EXPECT_EQ(error, "mesh: a name cannot contain a zero byte");
    EXPECT_EQ(allowed_text(Paths {}), "FILE");
}
