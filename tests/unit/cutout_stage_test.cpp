// SPDX-License-Identifier: Apache-2.0
// Cut-outs from files: what is read, what is refused, what is noticed.
#include "gltf_file.h"
#include "stage_scene.h"

#include <vmlight/frame/lit_object.h>
#include <vmlight/mesh/opacity.h>
#include <vmlight/reference/reference.h>
#include <vmlight/stage/cutouts.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/trace/bake_scene.h>

#include <gmock/gmock.h>

#include <cmath>
#include <memory>

using namespace vmlight;
using namespace vmlight::stage_scene;
using mesh_files::json;
using OIIO::ImageBuf;
using testing::HasSubstr;
using testing::Not;

namespace {

// A floor at z = 0 in material Floor, and above it a roof in material Roof, whose texture is over it once; both over
// all of the UVs.
const char* const kFloorText = "mtllib room.mtl\n"
                               "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv -9 -9 1\nv 9 -9 1\nv 9 9 1\nv -9 9 1\n"
                               "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n"
                               "usemtl Floor\nf 1/1/1 2/2/1 3/3/1 4/4/1\n";
const char* const kRoof = "usemtl Roof\nf 5/1/1 6/2/1 7/3/1 8/4/1\n";

class CutoutStage : public testing::Test
{
protected:
    CutoutStage() { declare_formats(); }

    // An image with an alpha of `left` and `right` halves, in four channels or one.
    void write_alpha(const std::string& name, float left, float right, int channels = 4) const
    {
        OIIO::ImageSpec spec(16, 16, channels, OIIO::TypeUInt8);
        spec.attribute("oiio:UnassociatedAlpha", 1);
        ImageBuf image(spec);
        const std::vector<float> l { 1, 1, 1, left }, r { 1, 1, 1, right };
        OIIO::ImageBufAlgo::fill(image, OIIO::cspan<float>(l.data() + 4 - channels, channels));
        OIIO::ImageBufAlgo::fill(image, OIIO::cspan<float>(r.data() + 4 - channels, channels),
                                 OIIO::ROI(8, 16, 0, 16, 0, 1, 0, channels));
        ASSERT_TRUE(image.write(folder / name)) << image.geterror();
    }
    VismapRecipe room(const std::string& roof) const
    {
        folder.write("room.mtl", "newmtl Floor\nKd 1 1 1\nnewmtl Roof\nKd 1 1 1\n" + roof);
        VismapRecipe recipe;
        recipe.mesh = folder.write("room.obj", std::string(kFloorText) + kRoof);
        recipe.selection.material = { "Floor" };
        recipe.vismap_params.resolution = { 8, 8 };
        recipe.vismap_params.samples = 256;
        recipe.vismap_params.margin = 0;
        return recipe;
    }
    ImageBuf made(const VismapRecipe& recipe)
    {
        ImageBuf image;
        MakeOptions options;
        said.clear();
        warned.clear();
        options.scene = &scene;
        options.say = [&](const std::string& line) { said += line + "\n"; };
        options.warn = [&](const std::string& line) { warned += line + "\n"; };
        EXPECT_TRUE(make_image(image, recipe, options)) << image.geterror();
        return image;
    }
    std::string refusal(const VismapRecipe& recipe)
    {
        ImageBuf image;
        EXPECT_FALSE(make_image(image, recipe, {}));
        return image.geterror();
    }
    // Of the four texels in the middle, whose mean is right below the middle of the roof.
    static double seen(const ImageBuf& image, int channel = 0)
    {
        double sum = 0;
        for (int i = 0; i < 4; ++i)
            sum += image.getchannel(3 + i % 2, 3 + i / 2, 0, channel);
        return sum / 4;
    }

    const TemporaryFolder folder;
    std::shared_ptr<const BakeScene> scene;
    std::string said, warned;
};

// A roof of half extent 9 at height 1 leaves this.
const double kUnderRoof = 1 - 4 / M_PI * 9 / std::sqrt(82.0) * std::atan(9 / std::sqrt(82.0));

std::string attribute_of(const ImageBuf& image, const char* name)
{
    return std::string(image.spec().get_string_attribute(name));
}

} // namespace

TEST_F(CutoutStage, AMapOfOpacityOpensTheRoof)
{
    write_alpha("roof.png", 0, 1, 1);
    EXPECT_NEAR(seen(made(room(""))), kUnderRoof, 0.02);
    EXPECT_THAT(said, Not(HasSubstr("cut-outs")));
    const ImageBuf half = made(room("map_d roof.png\n"));
    EXPECT_NEAR(seen(half), (1 + kUnderRoof) / 2, 0.02);
    EXPECT_THAT(said, HasSubstr("cut-outs: 2 triangles, 0 opaque, 0 transparent, 2 in part: "));
    EXPECT_EQ(attribute_of(half, "vmlight:cutouts"), "auto");
    EXPECT_EQ(warned, "");
    // The half that is open is at -x.
    EXPECT_LT(seen(half, 1), -0.1);
}

TEST_F(CutoutStage, OffTakesAllSurfacesAsOpaque)
{
    VismapRecipe recipe = room("d 0.25\nmap_d none.png\n");
    recipe.cutout_params.cutouts = "off";
    const ImageBuf off = made(recipe);
    EXPECT_NEAR(seen(off), kUnderRoof, 0.02);
    EXPECT_EQ(attribute_of(off, "vmlight:cutouts"), "off");
    EXPECT_EQ(made(room("")).spec().find_attribute("vmlight:cutouts"), nullptr);
}

TEST_F(CutoutStage, AConstantOpacityStopsItsShare)
{
    const ImageBuf quarter = made(room("d 0.25\n"));
    EXPECT_NEAR(seen(quarter), 1 - 0.25 * (1 - kUnderRoof), 3 * std::sqrt(0.25 * 0.75 / 256));
    EXPECT_EQ(scene->occluder().cutouts().mixed, 2);
    const ImageBuf none = made(room("d 0\n"));
    EXPECT_EQ(seen(none), 1);
    EXPECT_EQ(scene->occluder().cutout_work().hits, 0);
    EXPECT_THAT(warned, HasSubstr("cut-outs: 2 triangles with a material that says so are transparent everywhere"));
}

TEST_F(CutoutStage, AlphaOfOneIsAsNone)
{
    write_alpha("ones.png", 1, 1);
    const std::vector<float> plain = all_pixels(made(room("")));
    const int64_t before = work_counts().alphas_read;
    EXPECT_EQ(all_pixels(made(room("map_d ones.png\n"))), plain);
    EXPECT_EQ(scene->occluder().cutouts().triangles, 0);
    EXPECT_EQ(scene->occluder().cutouts().bytes, 0u);
    EXPECT_EQ(scene->occluder().cutout_work().hits, 0);
    EXPECT_EQ(work_counts().alphas_read - before, 1);
    // Nobody reads a texture whose alpha no material asks for, or that has none.
    write_alpha("color.png", 1, 1, 4);
    made(room("map_Kd color.png\n"));
    EXPECT_EQ(work_counts().alphas_read - before, 1);
}

TEST_F(CutoutStage, ATextureThatIsMissingOrBrokenIsNamed)
{
    const std::string wanted = "material \"Roof\" needs the alpha of its texture: \"";
    EXPECT_THAT(refusal(room("map_d none.png\n")),
                testing::AllOf(HasSubstr("room.obj\": " + wanted + folder / "none.png" + "\": no such file"),
                               HasSubstr("--cutouts off")));
    folder.write("broken.png", "\x89PNG\r\n\x1a\n and no more");
    EXPECT_THAT(refusal(room("map_d broken.png\n")), HasSubstr(wanted + folder / "broken.png"));
    // Of materials that nothing has, nothing is asked.
    VismapRecipe recipe = room("newmtl Other\nmap_d none.png\n");
    made(recipe);
    recipe.occluder = { folder.write("more.obj", "mtllib more.mtl\nv 0 0 5\nv 1 0 5\nv 0 1 5\nusemtl A\nf 1 2 3\n") };
    folder.write("more.mtl", "newmtl A\nmap_d gone.png\n");
    EXPECT_THAT(refusal(recipe), testing::AllOf(HasSubstr("more.obj"), HasSubstr("gone.png\": no such file")));
}

TEST_F(CutoutStage, AChangedTextureIsNoticed)
{
    write_alpha("roof.png", 0, 0, 1);
    const VismapRecipe recipe = room("map_d roof.png\n");
    EXPECT_EQ(seen(made(recipe)), 1);
    const std::shared_ptr<const BakeScene> first = scene;
    made(recipe);
    EXPECT_EQ(scene, first) << "shared";
    write_alpha("roof.png", 1, 1, 1);
    EXPECT_NEAR(seen(made(recipe)), kUnderRoof, 0.02);
    EXPECT_NE(scene, first);
    VismapRecipe off = recipe;
    off.cutout_params.cutouts = "off";
    const std::shared_ptr<const BakeScene> second = scene;
    made(off);
    EXPECT_NE(scene, second);
}

TEST_F(CutoutStage, ReadersSeeTheSame)
{
    write_alpha("roof.png", 0, 1, 1);
    const ImageBuf map = made(room("map_d roof.png\n"));
    folder.write("room.vismap",
                 "mesh = \"room.obj\"\nmaterial = \"Floor\"\nresolution = 8\nsamples = 256\nmargin = 0\n");
    ImageBuf opened(folder / "room.vismap"), off(folder / "room.vismap?cutouts=off");
    ASSERT_TRUE(opened.read(0, 0, true, OIIO::TypeFloat)) << opened.geterror();
    ASSERT_TRUE(off.read(0, 0, true, OIIO::TypeFloat)) << off.geterror();
    EXPECT_EQ(all_pixels(opened), all_pixels(map));
    EXPECT_NEAR(seen(off), kUnderRoof, 0.02);
    EXPECT_EQ(attribute_of(off, "vmlight:cutouts"), "off");
    VismapRecipe recipe;
    std::string error;
    EXPECT_FALSE(read_recipe(recipe, folder / "room.vismap?cutouts=on", error));
    EXPECT_THAT(error, HasSubstr("auto"));
}

TEST_F(CutoutStage, UnwrappingKeepsTheCutOutsWhereTheyWere)
{
    write_alpha("roof.png", 0, 1, 1);
    VismapRecipe recipe = room("map_d roof.png\n");
    recipe.vismap_params.resolution = { 64, 64 };
    recipe.vismap_params.samples = 16;
    const ImageBuf own = made(recipe);
    recipe.selection = {};
    recipe.unwrap = true;
    made(recipe);
    EXPECT_EQ(scene->occluder().cutouts().mixed, 2);
    EXPECT_NE(scene->mesh().opacity->uvs[0].size(), 0u);
    EXPECT_EQ(scene->mesh().opacity->uvs[0].size(), 3 * scene->mesh().triangles.size());
}

TEST_F(CutoutStage, GltfMasksAndOtherUvSets)
{
    write_alpha("leaf.png", 0, 1);
    mesh_files::GltfFile file = mesh_files::triangle_file();
    // The second set is all in the left half of the texture, the first in the right one.
    const size_t left = file.add_accessor<float>({ 0.1f, 0.1f, 0.2f, 0.1f, 0.1f, 0.2f }, "VEC2");
    const size_t right = file.add_accessor<float>({ 0.7f, 0.1f, 0.9f, 0.1f, 0.7f, 0.2f }, "VEC2");
    file.primitive()["attributes"]["TEXCOORD_0"] = right;
    file.primitive()["attributes"]["TEXCOORD_1"] = left;
    file.primitive()["material"] = 0;
    const size_t view = file.add_view(folder.bytes("leaf.png"));
    // Compilers differ in what a list of one is.
    file.root["images"] = json::array({ json { { "bufferView", view }, { "mimeType", "image/png" } } });
    file.root["textures"] = json::array({ json { { "source", 0 } } });
    json material = { { "name", "leaf" }, { "alphaMode", "MASK" } };
    material["pbrMetallicRoughness"]["baseColorTexture"] = { { "index", 0 } };
    file.root["materials"] = json::array({ material });
    VismapRecipe recipe;
    recipe.vismap_params.resolution = { 4, 4 };
    const auto counts = [&](const char* name) {
        recipe.mesh = folder.write(name, file.glb());
        made(recipe);
        return scene->occluder().cutouts();
    };
    EXPECT_EQ(counts("right.glb").opaque, 1);
    file.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 1;
    EXPECT_EQ(counts("left.glb").transparent, 1);
    file.root["materials"][0]["alphaMode"] = "OPAQUE";
    EXPECT_EQ(counts("opaque.glb").triangles, 0);
    file.root["materials"][0]["alphaMode"] = "MASK";
    file.root["images"] = json::array({ json { { "uri", "none.png" } } });
    recipe.mesh = folder.write("missing.gltf", file.text());
    EXPECT_THAT(refusal(recipe),
                testing::AllOf(HasSubstr("material \"leaf\" needs the alpha of its texture: image 0: "),
                               HasSubstr("none.png"), HasSubstr("--cutouts off")));
}

TEST_F(CutoutStage, TheTracedReferenceAndFramesSeeThemToo)
{
    write_alpha("roof.png", 0, 0, 1);
    const VismapRecipe recipe = room("map_d roof.png\n");
    made(recipe);
    ImageBuf sky(OIIO::ImageSpec(16, 8, 3, OIIO::TypeFloat)), traced;
    OIIO::ImageBufAlgo::fill(sky, { 1.0f, 2.0f, 3.0f });
    ReferenceParams params;
    params.samples = 16;
    ASSERT_TRUE(make_reference(traced, *scene, sky, recipe.vismap_params, {}, params, 1, {})) << traced.geterror();
    EXPECT_NEAR(traced.getchannel(4, 4, 0, 1), 2, 5 * traced.getchannel(4, 4, 0, 4)); // else about 0.02
    EXPECT_LT(traced.getchannel(4, 4, 0, 4), 0.2f);

    SceneLight light;
    light.filtered.emplace_back(sky);
    LightmapParams paper;
    paper.model = "paper";
    for (const bool is_on : { true, false }) {
        ObjectRecipe object;
        object.map = recipe;
        object.map.selection = {};
        object.map.cutout_params.cutouts = is_on ? "auto" : "off";
        object.map.mesh = folder.write("floor.obj", kFloorText);
        LitObject floor, roof;
        std::string error;
        ASSERT_TRUE(floor.open(object, {}, error)) << error;
        object.map.mesh = folder.write(
            "roof.obj", std::string(kFloorText).substr(0, std::string(kFloorText).find("usemtl")) + kRoof);
        ASSERT_TRUE(roof.open(object, {}, error)) << error;
        floor.set_occluders({ roof.surface() });
        ASSERT_TRUE(floor.light(light, paper, {}, {}, error)) << error;
        float rgb[3];
        ASSERT_TRUE(floor.surface().light->lookup({ Imath::V2d(0.5, 0.5) }, rgb, error));
        EXPECT_NEAR(rgb[1], is_on ? 2 : 2 * kUnderRoof, 0.05);
    }
}
