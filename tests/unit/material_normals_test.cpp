// SPDX-License-Identifier: Apache-2.0
// Normal maps that materials name, inside a GLB: as if they were given.
#include "gltf_file.h"
#include "stage_scene.h"

#include <vmlight/stage/make_stage.h>

#include <gmock/gmock.h>

#include <cstring>
#include <fstream>
#include <iterator>

using namespace vmlight;
using namespace vmlight::stage_scene;
using mesh_files::GltfFile;
using mesh_files::json;
using OIIO::ImageBuf;

namespace {

class MaterialNormalMaps : public testing::Test
{
protected:
    MaterialNormalMaps()
    {
        declare_formats();
        ImageBuf image(OIIO::ImageSpec(8, 8, 3, OIIO::TypeUInt8));
        OIIO::ImageBufAlgo::noise(image, "uniform", 0.3f, 0.7f, false, 3);
        const float up[] { 1 };
        OIIO::ImageBufAlgo::fill(image, up, OIIO::ROI(0, 8, 0, 8, 0, 1, 2, 3));
        EXPECT_TRUE(image.write(folder / "bumps.png")) << image.geterror();
    }
    // A square whose material has bumps.png inside the file.
    GltfFile square() const
    {
        GltfFile file;
        std::ifstream png(folder / "bumps.png", std::ios::binary);
        const size_t view = file.add_view(std::string(std::istreambuf_iterator<char>(png), {}));
        const auto floats
            = [&](const std::vector<float>& numbers, const char* type) { return file.add_accessor(numbers, type); };
        file.primitive()["attributes"] = { { "POSITION", floats({ -1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0 }, "VEC3") },
                                           { "NORMAL", floats({ 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1 }, "VEC3") },
                                           { "TEXCOORD_0", floats({ 0, 1, 1, 1, 1, 0, 0, 0 }, "VEC2") } };
        file.primitive()["indices"] = file.add_accessor<uint16_t>({ 0, 1, 2, 0, 2, 3 }, "SCALAR");
        file.primitive()["material"] = 0;
        file.root["materials"] = { { { "normalTexture", { { "index", 0 } } } } };
        file.root["textures"] = { { { "source", 0 } } };
        file.root["images"] = { { { "bufferView", view }, { "mimeType", "image/png" } } };
        return file;
    }
    std::vector<float> baked(const std::string& glb, const char* normal_map, bool of_materials)
    {
        VismapRecipe recipe;
        recipe.mesh = folder.write("square.glb", glb);
        recipe.normal_map = normal_map ? folder / normal_map : "";
        recipe.material_normals = of_materials;
        recipe.vismap_params.resolution = { 16, 16 };
        recipe.vismap_params.samples = 16;
        recipe.vismap_params.channels = { "normal" };
        MakeOptions options;
        warnings.clear();
        options.warn = [&](const std::string& line) { warnings.push_back(line); };
        ImageBuf image;
        EXPECT_TRUE(make_image(image, recipe, options)) << image.geterror();
        return all_pixels(image);
    }
    TemporaryFolder folder;
    std::vector<std::string> warnings;
};

} // namespace

TEST_F(MaterialNormalMaps, InsideAGlbTheyAreAsIfGiven)
{
    const std::string glb = square().glb();
    const std::vector<float> own = baked(glb, nullptr, true), given = baked(glb, "bumps.png", false),
                             none = baked(glb, nullptr, false);
    EXPECT_EQ(own, given);
    EXPECT_NE(own, none);
    EXPECT_TRUE(warnings.empty());
}

TEST_F(MaterialNormalMaps, InAnotherUvSetTheyAreLeftOut)
{
    GltfFile file = square();
    file.primitive()["attributes"]["TEXCOORD_1"] = file.add_accessor<float>({ 0, 1, 1, 1, 1, 0, 0, 0 }, "VEC2");
    file.root["materials"][0]["normalTexture"]["texCoord"] = 1;
    const std::vector<float> own = baked(file.glb(), nullptr, true);
    EXPECT_THAT(warnings, testing::ElementsAre(testing::HasSubstr("in UV set 1, and set 0 is baked: left out")));
    EXPECT_EQ(own, baked(file.glb(), nullptr, false));
}

TEST_F(MaterialNormalMaps, AReaderSeesThem)
{
    const std::vector<float> made = baked(square().glb(), nullptr, true);
    folder.write("square.vismap",
                 "mesh = \"square.glb\"\nmaterial_normals = true\nresolution = 16\nsamples = 16\n"
                 "channels = [\"normal\"]\n");
    const auto in = OIIO::ImageInput::open(folder / "square.vismap");
    ASSERT_TRUE(in) << OIIO::geterror();
    EXPECT_EQ(all_pixels(*in), made);
}
