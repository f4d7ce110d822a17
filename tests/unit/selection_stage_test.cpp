// SPDX-License-Identifier: Apache-2.0
// Bakes of a part of a mesh, by recipes and readers.
#include "room.h"
#include "stage_scene.h"

#include <vmlight/base/format.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/trace/bake_scene.h>

#include <gmock/gmock.h>

using namespace vmlight;
using namespace vmlight::stage_scene;
using OIIO::ImageBuf;
using testing::HasSubstr;

namespace {

class Room : public TemporaryFolder
{
public:
    Room()
    {
        declare_formats();
        write("room.obj", room_obj());
    }
    VismapRecipe recipe(const MeshSelection& selection = {}) const
    {
        VismapRecipe recipe;
        recipe.mesh = *this / "room.obj";
        recipe.selection = selection;
        recipe.vismap_params.resolution = { 32, 32 };
        recipe.vismap_params.samples = 32;
        recipe.vismap_params.margin = 0;
        recipe.vismap_params.reconstruct = "off"; // a part's texels have the neighbours of the part
        return recipe;
    }
};

ImageBuf made_map(const VismapRecipe& recipe, const MakeOptions& options = {})
{
    ImageBuf image;
    EXPECT_TRUE(make_image(image, recipe, options)) << image.geterror();
    return image;
}

std::string attribute(const ImageBuf& image, const char* name)
{
    return std::string(image.spec().get_string_attribute(name));
}

// Every texel that `part` bakes has the bits of `whole`. Returns their number.
int expect_same_where_baked(const ImageBuf& part, const ImageBuf& whole)
{
    const std::vector<float> a = all_pixels(part), b = all_pixels(whole);
    int baked = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        EXPECT_TRUE(a[i] == 0 || a[i] == b[i]) << i;
        baked += a[i] != 0 && i % 4 == 0;
    }
    return baked;
}

} // namespace

TEST(SelectionStage, APartHasTheBitsOfTheWhole)
{
    const Room room;
    const ImageBuf whole = made_map(room.recipe());
    EXPECT_EQ(expect_same_where_baked(whole, whole), 3 * 256);
    EXPECT_EQ(expect_same_where_baked(made_map(room.recipe({ { "Stone" }, {} })), whole), 2 * 256);
    EXPECT_EQ(expect_same_where_baked(made_map(room.recipe({ {}, { "House" } })), whole), 2 * 256);
    EXPECT_EQ(expect_same_where_baked(made_map(room.recipe({ { "Stone" }, { "House" } })), whole), 256);
    // The wall occludes the floor.
    const ImageBuf floor = made_map(room.recipe({ {}, { "Ground" } }));
    EXPECT_EQ(expect_same_where_baked(floor, whole), 256);
    EXPECT_LT(floor.getchannel(8, 24, 0, 0), 0.9f);
}

TEST(SelectionStage, ReadersAndMetadataKnowThePart)
{
    const Room room;
    room.write("part.vismap",
               "mesh = \"room.obj\"\nmaterial = [\"Stone\"]\nnode = \"House\"\nresolution = 32\n"
               "samples = 32\nmargin = 0\nreconstruct = \"off\"\n");
    const ImageBuf part = made_map(room.recipe({ { "Stone" }, { "House" } }));
    ImageBuf opened(room / "part.vismap");
    ASSERT_TRUE(opened.read(0, 0, true, OIIO::TypeFloat)) << opened.geterror();
    EXPECT_EQ(all_pixels(opened), all_pixels(part));
    for (const ImageBuf* image : std::initializer_list<const ImageBuf*> { &opened, &part }) {
        EXPECT_EQ(attribute(*image, "vmlight:material"), "Stone");
        EXPECT_EQ(attribute(*image, "vmlight:node"), "House");
    }
    ImageBuf other(room / "part.vismap?node=Ground&material=St*&material=Brick");
    ASSERT_TRUE(other.read(0, 0, true, OIIO::TypeFloat)) << other.geterror();
    EXPECT_EQ(all_pixels(other), all_pixels(made_map(room.recipe({ {}, { "Ground" } }))));

    const ImageBuf whole = made_map(room.recipe());
    EXPECT_EQ(whole.spec().find_attribute("vmlight:material"), nullptr);
    EXPECT_NE(attribute(part, "vmlight:meshHash"), attribute(whole, "vmlight:meshHash"));
    EXPECT_EQ(attribute(whole, "vmlight:occluderHash"), "");
    const std::string rest = attribute(part, "vmlight:occluderHash");
    EXPECT_EQ(rest.size(), 16u);
    EXPECT_NE(rest, attribute(made_map(room.recipe({ { "Brick" }, {} })), "vmlight:occluderHash"));
    VismapRecipe with_occluder = room.recipe({ { "Stone" }, { "House" } });
    with_occluder.occluder = { room.write("more.obj", room_obj()) };
    EXPECT_EQ(attribute(made_map(with_occluder), "vmlight:occluderHash").substr(0, 17), rest + ",");
    // All that there is: the map of the whole mesh.
    EXPECT_EQ(attribute(made_map(room.recipe({ { "*" }, {} })), "vmlight:meshHash"),
              attribute(whole, "vmlight:meshHash"));
}

TEST(SelectionStage, PartsShareOneReadingAndOneScene)
{
    const Room room;
    const Work before;
    std::shared_ptr<const BakeScene> whole, scene;
    MakeOptions options;
    options.scene = &whole;
    std::vector<std::string> materials;
    std::string error;
    ASSERT_TRUE(vismap_materials(materials, room.recipe({ {}, { "House" } }), options, error)) << error;
    EXPECT_EQ(materials, (std::vector<std::string> { "Stone", "Brick" }));
    options.scene = &scene;
    for (const char* material : { "Stone", "Brick", "*" })
        made_map(room.recipe({ { material }, {} }), options);
    const Work work = Work() - before;
    EXPECT_EQ(work.meshes_read, 1);
    EXPECT_EQ(work.scenes_built, 1);
}

TEST(SelectionStage, ASmallPartOfALargeFileHasItsOwnPrecision)
{
    const TemporaryFolder folder;
    // Its first corner is number `first`.
    const auto quad = [](double x, double size, double z, int first, const char* node) {
        return format("v {} {} {}\nv {} {} {}\nv {} {} {}\nv {} {} {}\no {}\nf {}/1/1 {}/2/1 {}/3/1 {}/4/1\n", x, -size,
                      z, x + 2 * size, -size, z, x + 2 * size, size, z, x, size, z, node, first, first + 1, first + 2,
                      first + 3);
    };
    const std::string head = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n";
    VismapRecipe recipe;
    recipe.vismap_params.resolution = { 8, 8 };
    recipe.mesh = folder.write("large.obj", head + quad(-1e4, 5004, .5, 1, "Roof") + quad(7, 1, 0, 5, "Hero"));
    recipe.selection.node = { "Hero" };
    std::shared_ptr<const BakeScene> scene;
    MakeOptions options;
    options.scene = &scene;
    const ImageBuf part = made_map(recipe, options);
    EXPECT_EQ(scene->frame().scale, 1);
    EXPECT_EQ(scene->frame().centre, Imath::V3d(8, 0, 0));
    EXPECT_EQ(scene->triangle_count(), 4);
    EXPECT_LT(part.getchannel(3, 4, 0, 0), .6f);
    // As of two files.
    recipe.selection = {};
    recipe.mesh = folder.write("hero.obj", head + quad(7, 1, 0, 1, "Hero"));
    recipe.occluder = { folder.write("ground.obj", head + quad(-1e4, 5004, .5, 1, "Roof")) };
    const ImageBuf apart = made_map(recipe);
    EXPECT_EQ(all_pixels(part), all_pixels(apart));
    for (const char* hash : { "vmlight:meshHash", "vmlight:occluderHash" })
        EXPECT_EQ(attribute(part, hash), attribute(apart, hash));
}

TEST(SelectionStage, WhatIsWrongIsSaidWithItsPlace)
{
    const Room room;
    EXPECT_THAT(refusal(room.recipe({ { "Stne" }, {} })), HasSubstr("room.obj\": no material \"Stne\"; the file has "));
    room.write("part.vismap", "mesh = \"room.obj\"\nnode = [\"Hause\"]\n");
    ImageBuf image(room / "part.vismap");
    EXPECT_FALSE(image.read(0, 0, true, OIIO::TypeFloat));
    EXPECT_THAT(image.geterror(), HasSubstr("; did you mean \"House\"?"));
    std::string error;
    VismapRecipe recipe;
    MakeOptions options;
    options.chain = { room / "part.vismap" };
    ASSERT_TRUE(read_recipe(recipe, options.chain[0], error)) << error;
    ImageBuf again;
    EXPECT_FALSE(make_image(again, recipe, options));
    EXPECT_THAT(again.geterror(), HasSubstr("part.vismap\" line 2: node: \""));
}

TEST(SelectionStage, UvSetsThatAreThereAreNamed)
{
    const Room room;
    VismapRecipe recipe = room.recipe();
    recipe.mesh_params.uv_set = 2;
    EXPECT_THAT(refusal(recipe), HasSubstr("no texture coordinates in UV set 2; the mesh has UV set 0"));
    recipe.mesh = room.write("bare.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_THAT(refusal(recipe), HasSubstr("bare.obj\": no texture coordinates: unwrap the mesh"));
}
