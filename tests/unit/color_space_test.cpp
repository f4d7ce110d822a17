// SPDX-License-Identifier: Apache-2.0
// Which space an image is in: by its name, its tags, its numbers or who asks.
#include "color_case.h"

#include <OpenImageIO/filesystem.h>

#include <utility>

using namespace color_case;

TEST_F(Color, FileRulesNameTheSpace)
{
    const ColorSettings settings { kConfig, "" };
    const char *data = "Raw is data, used as ACEScg unchanged", *rec709 = "Linear Rec.709 (sRGB) -> ACEScg",
               *srgb = "sRGB - Texture -> ACEScg", *acescg = "ACEScg, unchanged";
    const std::vector<std::pair<const char*, const char*>> rules {
        { "spot_vismap.exr", data },
        { "/show/spot.vismap", data },
        { "spot.vismap?samples=64", data },
        { "hero_vm.exr", data },
        { "/a/b/hero_vm.1001.exr", data },
        { "hero_vm.<UDIM>.exr", data },
        { "hero_vm_u1_v1.tx", data },
        { "hero_vm.####.tif", data },
        { "hero_vm.%04d.exr", data },
        { "hero_vmlit.1001.exr", acescg },
        { "sky.cfem", acescg },
        { "hero.lightmap?vismap=hero_vm.exr", acescg },
        { "/show/vismap/sky.exr", acescg },
        { "/show/raw/sky.exr", acescg },
        { "SKY.EXR", acescg },
        { "sky.hdr", rec709 },
        { "sky.HDR", rec709 },
        { "sky_lin_rec709.exr", rec709 },
        { "sky_ACEScg.hdr", acescg },
        { "sky_lin_ap0_scene.exr", "ACES2065-1 -> ACEScg" },
        { "paint.png", srgb },
        { "paint.jpg", srgb },
        { "paint.JPEG", srgb },
        { "paint.tga", srgb },
        { "paint.bmp", srgb },
        { "paint_srgb.tif", srgb },
        { "paint_acescg.tif", acescg },
    };
    for (auto& [path, expected] : rules)
        EXPECT_EQ(said(path, settings), expected) << path;
}

// OIIO 2.4 finds the space Raw in "drawing.tif", and in every file of a folder of that name.
TEST_F(Color, ANameInsideAWordOrAFolderSaysNothing)
{
    for (const char* path : { "drawing.tif", "/show/raw/paint.tif", "/show/acescg.old/paint.tif", "strawberry.tif" }) {
        EXPECT_EQ(said(path, { kConfig, "" }, OIIO::TypeUInt8), "sRGB - Texture -> ACEScg") << path;
        EXPECT_EQ(said(path, { kConfig, "" }), "ACEScg, unchanged") << path;
    }
}

TEST_F(Color, WithoutARuleTheTagDecidesAndThenTheType)
{
    ImageBuf image = flat({ 0.5f, 0.5f, 0.5f });
    image.specmod().attribute("colorInteropID", "lin_ap0_scene");
    ASSERT_TRUE(convert(image, "sky.tif", { kConfig, "" })) << error;
    EXPECT_EQ(note, "ACES2065-1 -> ACEScg");

    // What OIIO 2.4 stamps on every EXR means nothing.
    ImageBuf stamped = flat({ 0.5f, 0.25f, 0.125f });
    stamped.specmod().attribute("oiio:ColorSpace", "Linear");
    ASSERT_TRUE(convert(stamped, "sky.tif", { kConfig, "" })) << error;
    EXPECT_EQ(note, "ACEScg, unchanged");
    EXPECT_EQ(stamped.spec().get_string_attribute("oiio:ColorSpace"), "");

    EXPECT_EQ(said("paint.tif", { kConfig, "" }, OIIO::TypeUInt16), "sRGB - Texture -> ACEScg");
    EXPECT_EQ(said("paint.tif", { kConfig, "" }, OIIO::TypeHalf), "ACEScg, unchanged");
    // A rule comes before the tag, and what is asked for before both.
    ImageBuf asked = flat({ 0.5f, 0.5f, 0.5f });
    asked.specmod().attribute("colorInteropID", "lin_ap0_scene");
    ASSERT_TRUE(convert(asked, "sky.hdr", { kConfig, "texture_paint" })) << error;
    EXPECT_EQ(note, "sRGB - Texture -> ACEScg");
}

TEST_F(Color, AFileKeepsItsWholeNumbersInMind)
{
    const std::string path = testing::TempDir() + "vmlight_color_test.tif";
    ASSERT_TRUE(flat({ 0.8f, 0.2f, 0.1f }, OIIO::TypeUInt8).write(path));
    ImageBuf image(path);
    ASSERT_TRUE(image.read(0, 0, true, OIIO::TypeFloat));
    EXPECT_TRUE(convert(image, path, { kConfig, "" })) << error;
    EXPECT_EQ(note, "sRGB - Texture -> ACEScg");
    expect_pixel(image, { 0.3819f, 0.0729f, 0.0251f }, 1e-4f);

    ImageBuf unread(path);
    EXPECT_TRUE(convert(unread, path, { kConfig, "" })) << error;
    expect_pixel(unread, { 0.3819f, 0.0729f, 0.0251f }, 1e-4f);
    OIIO::Filesystem::remove(path);
}

TEST_F(Color, RefusalsNameTheNearest)
{
    const std::string start = "ERROR OCIO config \"" + kConfig + "\" has no colour space ";
    EXPECT_EQ(said("sky.exr", { kConfig, "ACEScgg" }), start + "\"ACEScgg\"; did you mean \"ACEScg\"?");
    EXPECT_EQ(said("sky.exr", { kConfig, "lin_rec708" }), start + "\"lin_rec708\"; did you mean \"lin_rec709\"?");
    // OIIO would take "linear" for the role scene_linear; most who say it mean Rec.709.
    EXPECT_EQ(said("sky.exr", { kConfig, "linear" }).rfind(start + "\"linear\"; ", 0), 0u);
    EXPECT_EQ(said("sky.exr", { kConfig, "scene_linear" }), "ACEScg, unchanged");
    EXPECT_EQ(said("sky.exr", { kConfig, "aCeScG" }), "ACEScg, unchanged");
    EXPECT_EQ(said("sky.exr", { kConfig, "data" }), "Raw is data, used as ACEScg unchanged");
}
