// SPDX-License-Identifier: Apache-2.0
// Strands among the occluders of a scene: which are left out or refused, and which come from files.
#include "scenes.h"
#include "stage_scene.h"
#include "strand_files.h"
#include "strand_occluders.h"

#include <vmlight/mesh/import/strands/read_strands.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/vismap/open_triangles.h>

#include <OpenImageIO/imagebuf.h>

#include <gmock/gmock.h>

#include <limits>
#include <memory>
#include <string>

using namespace vmlight;
using namespace vmlight::strand_files;
using namespace vmlight::strand_occluders;

namespace {

class StrandOccluderStage : public testing::Test
{
protected:
    StrandOccluderStage()
    {
        folder.write("hair.tfx", tfx(5, 4));
        recipe.mesh = folder / "spot.obj";
        recipe.occluder = { folder / "hair.tfx" };
        recipe.strand_params.radius = "0.05:0.01";
        recipe.vismap_params.samples = 4;
        recipe.vismap_params.resolution = { 32, 32 };
    }
    OIIO::ImageBuf made()
    {
        OIIO::ImageBuf map;
        EXPECT_TRUE(make_image(map, recipe)) << map.geterror();
        return map;
    }
    stage_scene::Folder folder;
    VismapRecipe recipe;
};

} // namespace

TEST(StrandOccluder, IsLeftOutWhereNoRayCanMeetIt)
{
    const auto reach = [](double z, double distance) {
        BakeScene scene;
        std::string error;
        EXPECT_TRUE(scene.build(std::make_shared<Mesh>(scenes::floor_facing_z(1)), { occluder_of(cylinder(.02, z)) }, 1,
                                error, SceneChoice::within(distance)))
            << error;
        EXPECT_EQ(scene.reach()[0].strands, 1);
        EXPECT_EQ(scene.reach()[0].spans, 256);
        EXPECT_EQ(scene.occluder().has_strands(), scene.reach()[0].verdict == CasterReach::reaches);
        return scene.reach()[0].verdict;
    };
    const double far = std::numeric_limits<double>::infinity();
    EXPECT_EQ(reach(.5, far), CasterReach::reaches);
    EXPECT_EQ(reach(-.5, far), CasterReach::below_horizon);
    EXPECT_EQ(reach(-.01, far), CasterReach::reaches); // its radius rises above
    EXPECT_EQ(reach(.5, .4), CasterReach::too_far);
    EXPECT_EQ(reach(.5, .49), CasterReach::reaches); // as far as its axis
}

TEST(StrandOccluder, NoTriangleBelowOneIsOpen)
{
    const Mesh floor = scenes::floor_facing_z(1);
    BakeScene scene;
    std::string error;
    ASSERT_TRUE(scene.build(non_owning(floor), { occluder_of(cylinder(.02, .5)) }, 1, error)) << error;
    OpenTriangles open;
    open.find(scene, std::numeric_limits<double>::infinity(), 1e9);
    EXPECT_EQ(open.report().open, 0);
    EXPECT_FALSE(open.report().searched);
}

TEST(StrandOccluder, TooThinOrTooFarOnesAreRefused)
{
    const auto refusal = [](const Strands& strands) {
        BakeScene scene;
        std::string error;
        EXPECT_FALSE(
            scene.build(std::make_shared<Mesh>(scenes::floor_facing_z(1)), { occluder_of(strands) }, 1, error));
        return error;
    };
    EXPECT_THAT(refusal(straight({ { V3d(0), V3d(0, 0, 1e20) } }, .1)), testing::HasSubstr("point 1 is 3.3e+19 times"));
    Strands bare = cylinder(.1, 1);
    bare.radii.clear();
    EXPECT_THAT(refusal(bare), testing::HasSubstr("0 radii for 257 points"));
}

TEST_F(StrandOccluderStage, AMeshIsBakedUnderAFileOfStrands)
{
    const OIIO::ImageBuf map = made();
    EXPECT_EQ(map.spec().get_string_attribute("vmlight:radius"), "0.05:0.01");
    EXPECT_EQ(map.spec().find_attribute("vmlight:kernel"), nullptr);
    Strands strands;
    std::string error;
    ASSERT_TRUE(read_strands(strands, folder / "hair.tfx", {}, "0.05:0.01", error)) << error;
    EXPECT_EQ(map.spec().get_string_attribute("vmlight:occluderHash"), strands_hash(strands));
    recipe.occluder.clear();
    recipe.strand_params.radius.clear();
    EXPECT_NE(stage_scene::all_pixels(made()), stage_scene::all_pixels(map));
}

TEST_F(StrandOccluderStage, LinesOfAnObjAreStrandsWhereItHasNoFaces)
{
    recipe.occluder = { folder.write("lines.obj", "v 0 0 0\nv 0 1 0\nv 0 2 0\nl 1 2 3\n") };
    EXPECT_NE(made().spec().find_attribute("vmlight:occluderHash"), nullptr);
    EXPECT_EQ(made().spec().find_attribute("vmlight:kernel"), nullptr);
    // Both are lines: the first is baked.
    recipe.mesh = recipe.occluder[0];
    recipe.vismap_params.resolution = VismapParams().resolution;
    EXPECT_EQ(made().spec().get_string_attribute("vmlight:kernel"), "strand");
    // With faces it is a mesh, and the radius is for the lines of the first.
    recipe.occluder = { folder / "spot.obj" };
    EXPECT_EQ(made().spec().get_string_attribute("vmlight:kernel"), "strand");
    EXPECT_TRUE(has_lines_alone(recipe.mesh));
    EXPECT_FALSE(has_lines_alone(folder / "spot.obj"));
    EXPECT_FALSE(has_lines_alone(folder / "hair.tfx"));
    EXPECT_FALSE(has_lines_alone(folder / "none.obj"));
}

TEST_F(StrandOccluderStage, WithoutARadiusItIsRefused)
{
    recipe.strand_params.radius.clear();
    OIIO::ImageBuf map;
    EXPECT_FALSE(make_image(map, recipe));
    EXPECT_THAT(map.geterror(),
                testing::AllOf(testing::HasSubstr("hair.tfx"), testing::HasSubstr("--radius ROOT:TIP")));
}

TEST_F(StrandOccluderStage, AnotherRadiusIsAnotherScene)
{
    const auto pixels = stage_scene::all_pixels(made());
    recipe.strand_params.radius = "0.3";
    EXPECT_NE(stage_scene::all_pixels(made()), pixels);
}

TEST_F(StrandOccluderStage, StrandsAreBakedAmongOthers)
{
    recipe.mesh = folder.write("own.tfx", tfx(2, 3));
    recipe.vismap_params.resolution = VismapParams().resolution;
    recipe.strand_params.radius = "0.1";
    const OIIO::ImageBuf among = made();
    recipe.occluder.clear();
    const OIIO::ImageBuf alone = made();
    EXPECT_EQ(among.spec().get_string_attribute("vmlight:kernel"), "strand");
    EXPECT_LT(among.getchannel(8, 1, 0, 0), alone.getchannel(8, 1, 0, 0));
}
