// SPDX-License-Identifier: Apache-2.0
// Light from one space to another, the configs that do it, and the tags it leaves. Which space an image is in:
// color_space_test.cpp.
#include "color_case.h"

#include <OpenImageIO/color.h>
#include <OpenImageIO/filesystem.h>

#include <cmath>
#include <cstdlib>
#include <limits>

using namespace color_case;

// The columns of the matrix from Rec.709 (D65) to AP1 (D60) through Bradford's adaptation; each row sums to 1.
TEST_F(Color, LinearRec709GoesToAcescgByTheKnownMatrix)
{
    const float columns[3][3] = { { 0.613097f, 0.070194f, 0.020616f },
                                  { 0.339523f, 0.916354f, 0.109570f },
                                  { 0.047379f, 0.013452f, 0.869815f } };
    for (int c = 0; c < 3; ++c) {
        std::vector<float> primary(3, 0.0f);
        primary[c] = 1.0f;
        ImageBuf image = flat(primary);
        ASSERT_TRUE(convert(image, "sky.exr", { kConfig, "lin_rec709_scene" })) << error;
        EXPECT_EQ(note, "Linear Rec.709 (sRGB) -> ACEScg");
        expect_pixel(image, { columns[c][0], columns[c][1], columns[c][2] }, 2e-5f);
    }
    ImageBuf sun = flat({ 118272.0f, 118272.0f, 118272.0f });
    ASSERT_TRUE(convert(sun, "sky.hdr", { kConfig, "" })) << error;
    expect_pixel(sun, { 118272.0f, 118272.0f, 118272.0f }, 118272.0f * 1e-5f);
}

TEST_F(Color, ATexturesSrgbGoesToAcescg)
{
    ImageBuf image = flat({ 0.8f, 0.2f, 0.1f });
    ASSERT_TRUE(convert(image, "albedo.png", { kConfig, "" })) << error;
    EXPECT_EQ(note, "sRGB - Texture -> ACEScg");
    expect_pixel(image, { 0.381920f, 0.072856f, 0.024794f }, 1e-5f); // by hand: the curve, then the matrix above

    // Whole numbers do not stay whole: dark colours would be lost.
    ImageBuf bytes = flat({ 204 / 255.0f, 51 / 255.0f, 26 / 255.0f }, OIIO::TypeUInt8);
    ASSERT_TRUE(convert(bytes, "albedo.png", { kConfig, "" })) << error;
    EXPECT_EQ(bytes.spec().format, OIIO::TypeFloat);
    expect_pixel(bytes, { 0.381934f, 0.072860f, 0.025061f }, 1e-5f);
}

TEST_F(Color, TheSameLightInTwoSpacesIsTheSameAfterwards)
{
    ImageBuf rec709(ImageSpec(64, 32, 3, OIIO::TypeFloat));
    OIIO::ImageBufAlgo::noise(rec709, "uniform", 0.0f, 20.0f, false, 1);
    ImageBuf acescg = rec709.copy(OIIO::TypeFloat);
    ASSERT_TRUE(convert(acescg, "", { kConfig, "Linear Rec.709 (sRGB)" })) << error;

    ImageBuf again = acescg.copy(OIIO::TypeFloat);
    ASSERT_TRUE(convert(again, "light.exr", { kConfig, "lin_ap1_scene" })) << error;
    EXPECT_EQ(note, "ACEScg, unchanged");
    ASSERT_TRUE(convert(rec709, "light.hdr", { kConfig, "" })) << error;
    const auto difference = OIIO::ImageBufAlgo::compare(rec709, again, 1e-4f, 1e-4f);
    EXPECT_LE(difference.maxerror, 1e-4);
    EXPECT_EQ(id_of(rec709), id_of(again));
}

TEST_F(Color, WithoutAConfigSrgbAndKnownPrimariesAreConverted)
{
    EXPECT_EQ(said("sky.hdr", {}), "lin_rec709_scene, unchanged (no OCIO config)");
    EXPECT_EQ(said("sky.exr", {}, OIIO::TypeHalf), "lin_rec709_scene, unchanged (no OCIO config)");
    EXPECT_EQ(said("paint.exr", { "", "sRGB" }), "srgb_rec709_scene -> lin_rec709_scene (no OCIO config)");
    EXPECT_EQ(said("paint.png", { "", "linear" }, OIIO::TypeUInt8), "lin_rec709_scene, unchanged (no OCIO config)");
    EXPECT_EQ(said("map.exr", { "", "raw" }), "data, used as lin_rec709_scene unchanged (no OCIO config)");
    EXPECT_EQ(said("map.exr", { "", "ACEScg" }),
              "ERROR colour space \"ACEScg\" needs an OCIO config: set --colorconfig or $OCIO; without one only "
              "srgb_rec709_scene, data and lin_ap1_scene, lin_ap0_scene, lin_rec709_scene, lin_p3d65_scene, "
              "lin_rec2020_scene, lin_ciexyzd65_scene are known");

    ImageBuf image = flat({ 0.8f, 0.2f, 0.02f, 0.5f }, OIIO::TypeUInt16);
    ASSERT_TRUE(convert(image, "paint.png", {})) << error;
    expect_pixel(image, { 0.603827f, 0.033105f, 0.001548f, 0.5f }, 2e-5f);
    EXPECT_EQ(id_of(image), "lin_rec709_scene");

    ImageBuf labelled = flat({ 0.613097f, 0.070194f, 0.020616f });
    labelled.specmod().attribute("colorInteropID", "lin_ap1_scene");
    ASSERT_TRUE(convert(labelled, "sky.exr", {})) << error;
    EXPECT_EQ(note, "lin_ap1_scene -> lin_rec709_scene (no OCIO config)");
    EXPECT_EQ(id_of(labelled), "lin_rec709_scene");
    expect_pixel(labelled, { 1, 0, 0 }, 2e-5f);

    // A file that says more than we can convert keeps its word.
    ImageBuf tagged = flat({ 0.8f, 0.2f, 0.1f });
    tagged.specmod().attribute("colorInteropID", "studio_log");
    ASSERT_TRUE(convert(tagged, "sky.exr", {})) << error;
    EXPECT_EQ(note, "studio_log, unchanged (no OCIO config)");
    EXPECT_EQ(id_of(tagged), "studio_log");
}

TEST_F(Color, TheEnvironmentsConfigIsTheDefault)
{
    setenv("OCIO", kConfig.c_str(), 1);
    EXPECT_EQ(said("sky.hdr", {}), "Linear Rec.709 (sRGB) -> ACEScg");
    setenv("OCIO", "", 1);
    EXPECT_EQ(said("sky.hdr", {}), "lin_rec709_scene, unchanged (no OCIO config)");
    setenv("OCIO", "/nowhere/config.ocio", 1);
    EXPECT_EQ(said("sky.hdr", {}).rfind("ERROR OCIO config \"/nowhere/config.ocio\": ", 0), 0u);
    EXPECT_EQ(said("sky.hdr", { kConfig, "" }), "Linear Rec.709 (sRGB) -> ACEScg");
}

TEST_F(Color, AConfigThatIsBuiltIntoOpenColorIOServes)
{
    const ColorSettings built_in { "ocio://cg-config-v1.0.0_aces-v1.3_ocio-v2.1", "" };
    if (OIIO::ColorConfig::OpenColorIO_version_hex() < 0x02020000) { // none is
        EXPECT_EQ(said("sky.hdr", built_in).rfind("ERROR OCIO config \"ocio://", 0), 0u);
        return;
    }
    ImageBuf image = flat({ 1, 0, 0 });
    ASSERT_TRUE(convert(image, "sky.exr", { built_in.config, "Linear Rec.709 (sRGB)" })) << error;
    expect_pixel(image, { 0.613097f, 0.070194f, 0.020616f }, 2e-5f);
    EXPECT_EQ(id_of(image), "lin_ap1_scene");
    setenv("OCIO", built_in.config.c_str(), 1);
    EXPECT_EQ(said("paint.png", { "", "ACEScg" }), "ACEScg, unchanged");
}

TEST_F(Color, ARefusedImageIsAsItWas)
{
    ImageBuf image = flat({ 0.8f, 0.2f, 0.1f }, OIIO::TypeUInt8);
    image.specmod().attribute("colorInteropID", "lin_ap0_scene");
    EXPECT_FALSE(convert(image, "x.png", { kConfig, "nothing of the kind" }));
    EXPECT_EQ(image.spec().format, OIIO::TypeUInt8);
    EXPECT_EQ(id_of(image), "lin_ap0_scene");

    ImageBuf vismap = flat({ 0.5f, 0.5f, 0.5f });
    vismap.specmod().attribute("vmlight:stage", "vismap");
    EXPECT_FALSE(convert(vismap, "x.exr", { kConfig, "" }));
    EXPECT_EQ(error, "\"x.exr\": a visibility map, not light: its vmlight:stage is \"vismap\"");
}

TEST_F(Color, ConfigsWithoutWhatWeNeedAreRefused)
{
    const std::string path = testing::TempDir() + "vmlight_color_test.ocio";
    const auto write = [&](const std::string& roles) {
        OIIO::Filesystem::write_text_file(path,
                                          "ocio_profile_version: 2\nroles:\n  default: Raw\n" + roles
                                              + "file_rules:\n  - !<Rule> {name: Default, colorspace: Raw}\n"
                                                "displays:\n  D:\n    - !<View> {name: V, colorspace: Raw}\n"
                                                "colorspaces:\n  - !<ColorSpace> {name: Raw, isdata: true}\n"
                                                "  - !<ColorSpace> {name: Studio Linear}\n");
    };
    write("");
    EXPECT_EQ(said("sky.exr", { path, "" }), "ERROR OCIO config \"" + path + "\" has no role scene_linear");
    write("  scene_linear: Studio Linear\n");
    EXPECT_EQ(said("sky.exr", { path, "" }), "Studio Linear, unchanged");
    EXPECT_EQ(said("paint.png", { path, "" }, OIIO::TypeUInt8),
              "ERROR \"paint.png\": integer pixels are taken as sRGB, but OCIO config \"" + path
                  + "\" has no colour space srgb_rec709_scene; specify the image's colour space");
    ImageBuf image = flat({ 1, 1, 1 });
    ASSERT_TRUE(convert(image, "sky.exr", { path, "" })) << error;
    EXPECT_EQ(id_of(image), "Studio Linear");
    EXPECT_EQ(image.spec().find_attribute("chromaticities"), nullptr);
    OIIO::Filesystem::write_text_file(path, "this is no config");
    EXPECT_EQ(said("sky.exr", { path, "" }).rfind("ERROR OCIO config \"" + path + "\": ", 0), 0u);
    OIIO::Filesystem::remove(path);
}

TEST_F(Color, OnlyColourIsConverted)
{
    ImageSpec spec(3, 3, 6, OIIO::TypeFloat);
    spec.channelnames = { "A", "depth", "B", "R", "G", "id" };
    spec.alpha_channel = 0;
    ImageBuf image(spec);
    OIIO::ImageBufAlgo::fill(image, { 0.25f, 7.0f, 0.0f, 1.0f, 0.0f, 3.0f });
    ASSERT_TRUE(convert(image, "sky.hdr", { kConfig, "" })) << error;
    expect_pixel(image, { 0.25f, 7.0f, 0.020616f, 0.613097f, 0.070194f, 3.0f }, 2e-5f);

    ImageBuf gray = flat({ 0.5f });
    ASSERT_TRUE(convert(gray, "mask.png", { kConfig, "" })) << error;
    expect_pixel(gray, { 0.214041f }, 2e-5f);
}

TEST_F(Color, ABadPixelStaysAloneAndBad)
{
    ImageBuf image = flat({ 1, 0, 0 });
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    const float bad[3] = { nan, 1.0f, inf };
    image.setpixel(0, 1, bad, 3);
    ASSERT_TRUE(convert(image, "sky.hdr", { kConfig, "" })) << error;
    float pixel[3];
    image.getpixel(0, 1, pixel, 3);
    EXPECT_TRUE(std::isnan(pixel[0]));
    EXPECT_EQ(pixel[1], 1.0f);
    EXPECT_EQ(pixel[2], inf);
    expect_pixel(image, { 0.613097f, 0.070194f, 0.020616f }, 2e-5f);
}

TEST_F(Color, TagsSayTheSpaceAndNothingStale)
{
    ImageSpec spec;
    spec.attribute("oiio:ColorSpace", "sRGB");
    tag_scene_linear(spec, "lin_ap1_scene");
    EXPECT_EQ(spec.get_string_attribute("colorInteropID"), "lin_ap1_scene");
    EXPECT_EQ(spec.find_attribute("oiio:ColorSpace"), nullptr);
    const OIIO::TypeDesc eight(OIIO::TypeDesc::FLOAT, 8);
    const OIIO::ParamValue* xy = spec.find_attribute("chromaticities", eight);
    ASSERT_NE(xy, nullptr);
    EXPECT_EQ(static_cast<const float*>(xy->data())[0], 0.713f);
    EXPECT_EQ(static_cast<const float*>(xy->data())[7], 0.33767f);

    tag_scene_linear(spec, "lin_rec709_scene");
    xy = spec.find_attribute("chromaticities", eight);
    ASSERT_NE(xy, nullptr);
    EXPECT_EQ(static_cast<const float*>(xy->data())[0], 0.64f);

    tag_scene_linear(spec, "studio_linear");
    EXPECT_EQ(spec.get_string_attribute("colorInteropID"), "studio_linear");
    EXPECT_EQ(spec.find_attribute("chromaticities"), nullptr);

    tag_scene_linear(spec, "lin_ap0_scene");
    tag_data(spec);
    EXPECT_EQ(spec.get_string_attribute("colorInteropID"), "data");
    EXPECT_EQ(spec.find_attribute("chromaticities"), nullptr);
}

TEST_F(Color, TagsSurviveAnExr)
{
    const std::string path = testing::TempDir() + "vmlight_color_test.exr";
    ImageBuf image = flat({ 1, 0, 0 });
    ASSERT_TRUE(convert(image, "sky.hdr", { kConfig, "" })) << error;
    ASSERT_TRUE(image.write(path)) << image.geterror();
    ImageBuf back(path);
    EXPECT_EQ(back.spec().get_string_attribute("colorInteropID"), "lin_ap1_scene");
    const OIIO::ParamValue* xy = back.spec().find_attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8));
    ASSERT_NE(xy, nullptr);
    EXPECT_EQ(static_cast<const float*>(xy->data())[2], 0.165f);
    OIIO::Filesystem::remove(path);
}
