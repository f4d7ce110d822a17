// SPDX-License-Identifier: Apache-2.0
#include "image_count.h"
#include "stage_scene.h"

#include <vmlight/base/work_counts.h>
#include <vmlight/cfem/stack.h>
#include <vmlight/image/image_file.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/stage/reader.h>

#include <OpenImageIO/imagebufalgo.h>

#include <filesystem>
#include <fstream>

using namespace vmlight;
using namespace stage_scene;
using OIIO::ImageBuf;
using OIIO::ImageInput;

TEST(StageInput, AReaderShowsThePixelsAndTheMetadataThatAnExecutableWrites)
{
    const Folder folder;
    const auto same = [](const std::string& name, const ImageBuf& made, std::vector<std::string> left_out) {
        const auto input = ImageInput::open(name);
        ASSERT_TRUE(input) << OIIO::geterror();
        EXPECT_EQ(all_pixels(*input), all_pixels(made)) << name;
        const OIIO::ImageSpec shown = input->spec();
        EXPECT_EQ(shown.channelnames, made.spec().channelnames);
        EXPECT_EQ(OIIO::get_roi_full(shown), OIIO::get_roi_full(made.spec()));
        for (const OIIO::ParamValue& value : made.spec().extra_attribs) {
            const OIIO::ParamValue* is = shown.find_attribute(value.name());
            const bool known = std::find(left_out.begin(), left_out.end(), value.name().string()) == left_out.end();
            EXPECT_EQ(is ? is->get_string() : "none", known ? value.get_string() : "none")
                << name << " " << value.name();
        }
        EXPECT_EQ(shown.extra_attribs.size() + left_out.size(), made.spec().extra_attribs.size()) << name;
    };
    same(folder / "hero.vismap", folder.vismap(), { "vmlight:meshHash", "vmlight:meshShape" });
    same(folder / "studio.cfem", folder.cfem(), {});
    LightmapParams turned;
    turned.rotate = { 0, 30, 0 };
    ImageBuf lightmap;
    ASSERT_TRUE(make_lightmap(lightmap, folder.vismap(), folder.cfem(), turned)) << lightmap.geterror();
    same(folder / "hero.lightmap", lightmap, { "vmlight:meshHash" });
}

TEST(StageInput, OpeningMakesNothing)
{
    const Folder folder;
    const Work before;
    for (const char* name : { "hero.vismap", "studio.cfem", "hero.lightmap", "hero.lightmap?rotate=0,45,0" }) {
        const auto input = ImageInput::open(folder / name);
        ASSERT_TRUE(input) << OIIO::geterror();
        EXPECT_EQ(input->spec().tile_width, 64);
        EXPECT_EQ(input->spec().format, OIIO::TypeFloat);
    }
    EXPECT_EQ(Work() - before, Work::none());
}

TEST(StageInput, OneTileOfALargeLightmapCostsThatTile)
{
    const Folder folder;
    folder.write("large.vismap", "mesh = \"spot.obj\"\nresolution = 8192\nsamples = 4\n");
    folder.write("large.lightmap", "vismap = \"large.vismap\"\ncfem = \"studio.cfem\"\n");
    const auto input = ImageInput::open(folder / "large.lightmap");
    ASSERT_TRUE(input) << OIIO::geterror();
    const Work before;
    std::vector<float> tile(64 * 64 * 3);
    ASSERT_TRUE(input->read_tile(64 * 60, 64 * 60, 0, OIIO::TypeFloat, tile.data())) << input->geterror();
    const Work work = Work() - before;
    EXPECT_LE(work.tiles_baked, 9);
    EXPECT_EQ(work.cfems_made, 1);
    EXPECT_EQ(work.tiles_shaded, 1);
}

TEST(StageInput, OpensOfOneRecipeShareItsWork)
{
    const Folder folder;
    const Work before;
    const auto first = all_pixels(*ImageInput::open(folder / "hero.lightmap"));
    const Work once = Work() - before;
    EXPECT_EQ(once.meshes_read, 1);
    EXPECT_EQ(once.cfems_made, 1);
    EXPECT_EQ(all_pixels(*ImageInput::open(folder / "hero.lightmap")), first);
    // Another rotation wants the same visibility map and the same light; so does the map's own recipe.
    EXPECT_NE(all_pixels(*ImageInput::open(folder / "hero.lightmap?rotate=0,90,0")), first);
    all_pixels(*ImageInput::open(folder / "hero.vismap"));
    const Work all = Work() - before;
    EXPECT_EQ(all.meshes_read, 1);
    EXPECT_EQ(all.cfems_made, 1);
    EXPECT_EQ(all.tiles_baked, once.tiles_baked);
}

TEST(StageInput, LevelsOfAStackAreSubimages)
{
    const Folder folder;
    const auto input = ImageInput::open(folder / "studio.cfem?stack=true");
    ASSERT_TRUE(input) << OIIO::geterror();
    const Work before;
    EXPECT_EQ(input->current_subimage(), 0);
    EXPECT_EQ(input->spec(8).get_float_attribute("vmlight:lobe"), float(stack_lobe(8)));
    EXPECT_TRUE(input->spec(10).undefined());
    EXPECT_TRUE(input->spec(0, 1).undefined());
    EXPECT_FALSE(input->seek_subimage(10, 0));
    EXPECT_FALSE(input->seek_subimage(0, 1));
    EXPECT_TRUE(input->seek_subimage(3, 0));
    EXPECT_EQ(input->current_subimage(), 3);
    EXPECT_EQ(input->spec().get_float_attribute("vmlight:lobe"), float(stack_lobe(3)));
    EXPECT_TRUE(Work() - before == Work::none());

    std::vector<ImageBuf> levels;
    std::string error;
    CfemRecipe recipe;
    recipe.environment = folder / "studio.exr";
    recipe.cfem_params.resolution = { 32, 16 };
    recipe.stack = true;
    ASSERT_TRUE(make_images(levels, recipe, {}, error)) << error;
    const Work made;
    for (int level = 9; level >= 0; --level) {
        std::vector<float> pixels(32 * 16 * 3);
        ASSERT_TRUE(input->read_image(level, 0, 0, 3, OIIO::TypeFloat, pixels.data())) << input->geterror();
        EXPECT_EQ(pixels, all_pixels(levels[size_t(level)])) << level;
    }
    EXPECT_EQ((Work() - made).cfems_made, 1);
    std::vector<float> tile(64 * 64 * 3);
    EXPECT_FALSE(input->read_native_tile(10, 0, 0, 0, 0, tile.data()));
    EXPECT_NE(input->geterror(), "");
    EXPECT_EQ(image_count(folder / "studio.cfem?stack=true"), kStackImages);
}

TEST(StageInput, AChangedInputIsReadAnew)
{
    const Folder folder;
    const auto before = all_pixels(*ImageInput::open(folder / "hero.lightmap"));
    ImageBuf brighter;
    std::string error;
    ASSERT_TRUE(read_image(brighter, folder / "studio.exr", error)) << error;
    ASSERT_TRUE(OIIO::ImageBufAlgo::mul(brighter, brighter, 2.0f));
    ASSERT_TRUE(brighter.write(folder / "studio.exr")) << brighter.geterror();
    const auto after = all_pixels(*ImageInput::open(folder / "hero.lightmap"));
    ASSERT_EQ(after.size(), before.size());
    for (size_t i = 0; i < after.size(); ++i)
        ASSERT_FLOAT_EQ(after[i], 2 * before[i]);
}

TEST(StageInput, AnInputThatChangesAfterOpenIsAnErrorOnEachRead)
{
    const Folder folder;
    const auto input = ImageInput::open(folder / "hero.vismap");
    ASSERT_TRUE(input);
    std::ofstream(folder / "spot.obj", std::ios::app) << "# changed\n";
    std::vector<float> tile(64 * 64 * 4);
    for (int i = 0; i < 2; ++i) {
        EXPECT_FALSE(input->read_tile(0, 0, 0, OIIO::TypeFloat, tile.data()));
        EXPECT_NE(input->geterror().find("spot.obj\": changed since it was opened"), std::string::npos);
    }
    EXPECT_TRUE(ImageInput::open(folder / "hero.vismap")->read_tile(0, 0, 0, OIIO::TypeFloat, tile.data()));
}

TEST(StageInput, AFailureIsToldOnEveryReadAndTriedAnewByTheNextOpen)
{
    const Folder folder;
    folder.write("bad.obj", "v 0 0 0\nthis is no mesh\n");
    folder.write("bad.vismap", "mesh = \"bad.obj\"\n");
    folder.write("bad.lightmap", "vismap = \"bad.vismap\"\ncfem = \"studio.cfem\"\n");
    for (const char* name : { "bad.vismap", "bad.lightmap" }) {
        const auto input = ImageInput::open(folder / name);
        ASSERT_TRUE(input) << OIIO::geterror(); // it takes the mesh itself to know
        std::vector<float> tile(64 * 64 * 4);
        for (int i = 0; i < 2; ++i) {
            EXPECT_FALSE(input->read_tile(0, 0, 0, OIIO::TypeFloat, tile.data()));
            EXPECT_NE(input->geterror().find("bad.obj"), std::string::npos);
        }
    }
}

TEST(StageInput, ChannelsAndRegionsAreServedFromTheirTiles)
{
    const Folder folder;
    const auto input = ImageInput::open(folder / "hero.vismap");
    ASSERT_TRUE(input);
    const std::vector<float> all = all_pixels(*input);
    const int width = input->spec().width, height = input->spec().height; // neither is a multiple of 64
    std::vector<float> some(size_t(width) * (height - 64) * 2);
    ASSERT_TRUE(input->read_tiles(0, 0, 0, width, 64, height, 0, 1, 1, 3, OIIO::TypeFloat, some.data()))
        << input->geterror();
    for (int y = 64; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 2; ++c)
                ASSERT_EQ(some[(size_t(y - 64) * width + x) * 2 + c], all[(size_t(y) * width + x) * 4 + c + 1]);
}

TEST(StageInput, AStoredMapMayBeCroppedHalfOrInScanlines)
{
    const Folder folder;
    ImageBuf half, cropped;
    half.copy(folder.vismap(), OIIO::TypeHalf);
    ASSERT_TRUE(half.write(folder / "half.exr", OIIO::TypeHalf)); // in scanlines, channels sorted
    cropped = OIIO::ImageBufAlgo::crop(folder.vismap(), OIIO::ROI(30, 130, 17, 99));
    ASSERT_TRUE(cropped.write(folder / "cropped.exr"));
    for (const char* name : { "half.exr", "cropped.exr" }) {
        folder.write("stored.lightmap", std::string("vismap = \"") + name + "\"\ncfem = \"studio.cfem\"\n");
        ImageBuf vismap, lightmap;
        std::string error;
        ASSERT_TRUE(read_image(vismap, folder / name, error)) << error;
        ASSERT_TRUE(make_lightmap(lightmap, vismap, folder.cfem())) << lightmap.geterror();
        const auto input = ImageInput::open(folder / "stored.lightmap");
        ASSERT_TRUE(input) << OIIO::geterror();
        EXPECT_EQ(OIIO::get_roi(input->spec()), lightmap.roi());
        EXPECT_EQ(all_pixels(*input), all_pixels(lightmap)) << name;
    }
}

TEST(StageInput, AnAlbedoIsConvertedAndResizedAsByTheExecutable)
{
    const Folder folder;
    ImageBuf albedo(OIIO::ImageSpec(20, 30, 3, OIIO::TypeUInt8)), lightmap;
    OIIO::ImageBufAlgo::noise(albedo, "uniform", 0.1f, 0.9f, false, 1);
    ASSERT_TRUE(albedo.write(folder / "paint.png"));
    folder.write("painted.lightmap", "vismap = \"hero.vismap\"\ncfem = \"studio.cfem\"\nalbedo = \"paint.png\"\n");
    std::string note, error;
    ASSERT_TRUE(read_image(albedo, folder / "paint.png", error)) << error;
    ASSERT_TRUE(to_scene_linear(albedo, folder / "paint.png", {}, note, error)) << error;
    EXPECT_NE(note.find("srgb"), std::string::npos);
    ASSERT_TRUE(make_lightmap(lightmap, folder.vismap(), folder.cfem(), {}, &albedo)) << lightmap.geterror();
    const auto input = ImageInput::open(folder / "painted.lightmap");
    ASSERT_TRUE(input) << OIIO::geterror();
    EXPECT_EQ(all_pixels(*input), all_pixels(lightmap));
}
