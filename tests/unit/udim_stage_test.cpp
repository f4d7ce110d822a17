// SPDX-License-Identifier: Apache-2.0
/// UDIM tiles as images: the right pixels, and the work that tiles share done once.
#include "stage_scene.h"

#include <vmlight/image/image_file.h>
#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/stage/recipe/udim.h>

#include <OpenImageIO/Imath.h>
#include <OpenImageIO/texture.h>

#include <cmath>
#include <thread>

using namespace vmlight;
using namespace stage_scene;
using OIIO::ImageBuf;
using OIIO::ImageInput;

namespace {

// A floor in tile 1001, and a wall beside it in 1012.
std::string tile_corner(double u, double v)
{
    std::string text = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 1 -1 2\nv 1 1 2\nvn 0 0 1\nvn -1 0 0\n";
    for (const auto& at : { std::pair(0.0, 0.0), std::pair(u, v) })
        for (const auto& [x, y] :
             { std::pair(.125, .125), std::pair(.875, .125), std::pair(.875, .75), std::pair(.125, .75) })
            text += "vt " + std::to_string(x + at.first) + " " + std::to_string(y + at.second) + "\n";
    return text + "f 1/1/1 2/2/1 3/3/1 4/4/1\nf 2/5/2 5/6/2 6/7/2 3/8/2\n";
}

class Tiles : public Folder
{
public:
    Tiles()
    {
        write("corner.obj", tile_corner(1, 1));
        write("corner.vismap", "mesh = \"corner.obj\"\nresolution = 40\nsamples = 16\nmargin = 3\n");
        write("corner.lightmap", "vismap = \"corner.vismap?udim=<UDIM>\"\ncfem = \"studio.cfem\"\n");
    }
    VismapRecipe recipe(int udim) const
    {
        VismapRecipe recipe;
        std::string error;
        EXPECT_TRUE(read_recipe(recipe, *this / "corner.vismap", error)) << error;
        recipe.vismap_params.udim = udim;
        return recipe;
    }
};

ImageBuf made_tile(const VismapRecipe& recipe, const MakeOptions& options = {})
{
    ImageBuf image;
    EXPECT_TRUE(make_image(image, recipe, options)) << image.geterror();
    return image;
}

std::vector<float> pixels_of(const std::string& name)
{
    const auto input = ImageInput::open(name);
    EXPECT_TRUE(input) << OIIO::geterror();
    return input ? all_pixels(*input) : std::vector<float>();
}

} // namespace

TEST(UdimStage, ATileIsTheMapOfTheMeshWithItsCoordinatesMovedThere)
{
    const Tiles folder;
    // The wall in 1001, and the floor where no tile is.
    const VismapRecipe moved = folder.recipe(1001);
    Mesh mesh;
    std::string error;
    ASSERT_TRUE(read_mesh(mesh, moved.mesh, {}, error)) << error;
    for (Imath::V2f& uv : mesh.uvs)
        uv -= Imath::V2f(1, 1);
    ImageBuf expected;
    ASSERT_TRUE(make_vismap(expected, mesh, {}, moved.vismap_params)) << expected.geterror();
    const ImageBuf tile = made_tile(folder.recipe(1012));
    EXPECT_EQ(all_pixels(tile), all_pixels(expected));
    EXPECT_NE(all_pixels(tile), all_pixels(made_tile(folder.recipe(1001))));
    EXPECT_EQ(tile.spec().get_string_attribute("vmlight:udim"), "1012");
    EXPECT_EQ(pixels_of(folder / "corner.vismap?udim=1012"), all_pixels(tile));
    for (float value : all_pixels(made_tile(folder.recipe(1044))))
        ASSERT_EQ(value, 0);
}

TEST(UdimStage, TilesOfOneMeshShareItAndTheRayTracersScene)
{
    const Tiles folder;
    {
        const Work before;
        std::shared_ptr<const BakeScene> scene;
        MakeOptions options;
        options.scene = &scene;
        for (int udim : { 1001, 1002, 1012 })
            made_tile(folder.recipe(udim), options);
        std::vector<int> udims;
        std::string error;
        ASSERT_TRUE(vismap_udims(udims, folder.recipe(1001), options, error)) << error;
        EXPECT_EQ(udims, (std::vector<int> { 1001, 1012 }));
        const Work work = Work() - before;
        EXPECT_EQ(work.meshes_read, 1);
        EXPECT_EQ(work.scenes_built, 1);
    }
    // In readers, by many threads, with what else is the scene's no matter.
    const Work before;
    std::vector<std::thread> threads;
    for (const char* query :
         { "udim=1001", "udim=1012", "udim=1002", "resolution=30", "seed=3", "samples=4&udim=1012" })
        threads.emplace_back([&folder, query] { pixels_of(folder / "corner.vismap?" + query); });
    for (std::thread& thread : threads)
        thread.join();
    Work work = Work() - before;
    EXPECT_EQ(work.meshes_read, 1);
    EXPECT_EQ(work.scenes_built, 1);
    // Other normals are another mesh.
    pixels_of(folder / "corner.vismap?normals=flat");
    work = Work() - before;
    EXPECT_EQ(work.scenes_built, 2);
}

TEST(UdimStage, ASceneThatCouldNotBeHadIsTriedAnew)
{
    const Tiles folder;
    folder.write("corner.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    for (int i = 0; i < 2; ++i) {
        ImageBuf image;
        EXPECT_FALSE(make_image(image, folder.recipe(1002)));
        EXPECT_NE(image.geterror().find("no texture coordinates"), std::string::npos);
    }
    std::vector<int> udims;
    std::string error;
    folder.write("corner.obj", tile_corner(-9, -9));
    EXPECT_TRUE(vismap_udims(udims, folder.recipe(1001), {}, error)) << error;
    folder.write("corner.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt -1 -1\nvt -2 -1\nvt -1 -2\nf 1/1 2/2 3/3\n");
    EXPECT_FALSE(vismap_udims(udims, folder.recipe(1001), {}, error));
    EXPECT_NE(error.find("corner.obj\": its texture coordinates are outside all UDIM tiles"), std::string::npos)
        << error;
}

TEST(UdimStage, AnEnvironmentIsFilteredOnceForAllTiles)
{
    const Tiles folder;
    LightmapRecipe recipe;
    recipe.vismap = folder / "corner.vismap?udim=<UDIM>";
    recipe.environment = folder / "studio.exr";
    std::shared_ptr<const BakeScene> scene;
    MakeOptions options;
    options.scene = &scene;
    LightmapInputs inputs;
    std::string error;
    const Work before;
    for (int udim : { 1001, 1012 }) {
        recipe.udim = udim;
        ASSERT_TRUE(read_lightmap_inputs(inputs, recipe, options, error)) << error;
        EXPECT_EQ(all_pixels(inputs.vismap), all_pixels(made_tile(folder.recipe(udim))));
    }
    EXPECT_EQ((Work() - before).cfems_made, 1);
    EXPECT_EQ((Work() - before).scenes_built, 1);
    recipe.cfem_params.resolution = { 8, 4 };
    ASSERT_TRUE(read_lightmap_inputs(inputs, recipe, options, error)) << error;
    EXPECT_EQ((Work() - before).cfems_made, 2);
}

TEST(UdimStage, ATextureSystemFindsTheTilesOfOneRecipeUnderSeveralNames)
{
    const Tiles folder;
    std::filesystem::create_symlink("corner.lightmap", folder / "lit.1001.lightmap");
    std::filesystem::copy(folder / "corner.lightmap", folder / "lit.1012.lightmap");
    auto textures = OIIO::TextureSystem::create(false);
    const OIIO::ustring name(folder / "lit.<UDIM>.lightmap");
    OIIO::TextureOpt options;
    options.interpmode = OIIO::TextureOpt::InterpClosest;
    options.mipmode = OIIO::TextureOpt::MipModeNoMIP;
    for (const auto& [udim, u, v] : { std::tuple(1001, 0, 0), std::tuple(1012, 1, 1) }) {
        const std::vector<float> expected = pixels_of(folder / "corner.lightmap?udim=" + std::to_string(udim));
        for (int y = 0; y < 40; y += 3)
            for (int x = 0; x < 40; x += 3) {
                float rgb[3] = {};
                // OIIO's t points down within a tile, and its tiles are counted upwards.
                const float s = float(u) + (float(x) + 0.5f) / 40, t = float(v) + (float(y) + 0.5f) / 40;
                ASSERT_TRUE(textures->texture(name, options, s, t, 0, 0, 0, 0, 3, rgb)) << textures->geterror();
                for (int c = 0; c < 3; ++c)
                    ASSERT_EQ(rgb[c], expected[size_t(40 * y + x) * 3 + size_t(c)]) << udim << " " << x << " " << y;
            }
    }
    OIIO::TextureSystem::destroy(textures, true);
}

TEST(UdimStage, LinksToOneRecipeAreRecipesOfTheirOwn)
{
    const Tiles folder;
    const std::string rest = "vismap = \"corner.vismap\"\ncfem = \"studio.cfem\"\nalbedo = ";
    folder.write("a.lightmap", rest + "\"b.<UDIM>.lightmap\"\n");
    folder.write("b.1001.lightmap", rest + "\"a.1002.lightmap\"\n");
    folder.write("b.1002.lightmap", rest + "\"\"\n");
    folder.write("ring.lightmap", rest + "\"other.lightmap\"\n");
    for (const char* name : { "a.1001.lightmap", "a.1002.lightmap" })
        std::filesystem::create_symlink("a.lightmap", folder / name);
    std::filesystem::create_symlink("ring.lightmap", folder / "other.lightmap");
    // a.1001 reads b.1001, which reads a.1002: the same file as a.1001, and no ring.
    LightmapRecipe recipe;
    std::string error;
    ImageBuf image;
    MakeOptions options;
    options.chain = { folder / "a.1001.lightmap" };
    ASSERT_TRUE(read_recipe(recipe, options.chain[0], error)) << error;
    ASSERT_TRUE(make_image(image, recipe, options)) << image.geterror();
    EXPECT_EQ(pixels_of(options.chain[0]), all_pixels(image));
    // A ring through a link is one.
    options.chain = { folder / "ring.lightmap" };
    ASSERT_TRUE(read_recipe(recipe, options.chain[0], error)) << error;
    EXPECT_FALSE(make_image(image, recipe, options));
    EXPECT_NE(image.geterror().find("reads itself"), std::string::npos);
    EXPECT_FALSE(ImageInput::open(options.chain[0]));
    EXPECT_NE(OIIO::geterror().find("reads itself"), std::string::npos);
}

TEST(UdimStage, LightSaysItsTileOnlyIfThatIsNotTheUsualOne)
{
    const Tiles folder;
    for (const char* name : { "corner.lightmap", "studio.cfem" }) {
        const auto usual = ImageInput::open(folder / name + "?udim=1001"),
                   other = ImageInput::open(folder / name + "?udim=1012");
        ASSERT_TRUE(usual && other) << OIIO::geterror();
        EXPECT_EQ(usual->spec().get_string_attribute("vmlight:udim"), "");
        EXPECT_EQ(other->spec().get_string_attribute("vmlight:udim"), "1012");
    }
    LightmapRecipe recipe;
    std::string error;
    ImageBuf image;
    ASSERT_TRUE(read_recipe(recipe, folder / "corner.lightmap?udim=1012", error)) << error;
    ASSERT_TRUE(make_image(image, recipe)) << image.geterror();
    EXPECT_EQ(image.spec().get_string_attribute("vmlight:udim"), "1012");
}
