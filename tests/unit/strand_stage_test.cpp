// SPDX-License-Identifier: Apache-2.0
// Strands through the stages: from their files and recipes to maps and light.
#include "stage_scene.h"
#include "strand_files.h"

#include <vmlight/stage/make_stage.h>

#include <gmock/gmock.h>

#include <cstring>

using namespace vmlight;
using namespace vmlight::strand_files;

namespace {

class StrandStage : public testing::Test
{
protected:
    StrandStage()
    {
        folder.write("hair.tfx", tfx(5, 4));
        recipe.mesh = folder / "hair.tfx";
        recipe.strand_params.radius = "0.05:0.01";
        recipe.vismap_params.samples = 16;
    }
    std::string refused(const VismapRecipe& given)
    {
        OIIO::ImageBuf map;
        EXPECT_FALSE(make_image(map, given));
        return map.geterror();
    }
    stage_scene::Folder folder;
    VismapRecipe recipe;
};

} // namespace

TEST_F(StrandStage, AFileOfStrandsBakesToAMapOfStrands)
{
    recipe.vismap_params.basis = "sh";
    recipe.occluder = { folder / "spot.obj" };
    OIIO::ImageBuf map;
    ASSERT_TRUE(make_image(map, recipe)) << map.geterror();
    const OIIO::ImageSpec& spec = map.spec();
    EXPECT_EQ(spec.width, 16);
    EXPECT_EQ(spec.height, 5);
    EXPECT_GE(spec.channelindex("tangent.x"), 0);
    EXPECT_GE(spec.channelindex("sh.24"), 0);
    for (const auto& [name, value] : std::vector<std::pair<std::string, std::string>> { { "stage", "vismap" },
                                                                                        { "kernel", "strand" },
                                                                                        { "mesh", "hair.tfx" },
                                                                                        { "radius", "0.05:0.01" },
                                                                                        { "strand_texels", "16" },
                                                                                        { "strands", "5" },
                                                                                        { "samples", "16" } })
        EXPECT_EQ(spec.get_string_attribute("vmlight:" + name), value) << name;
    for (const char* absent : { "resolution", "margin", "measure" })
        EXPECT_EQ(spec.find_attribute(std::string("vmlight:") + absent), nullptr) << absent;
    EXPECT_FALSE(spec.get_string_attribute("vmlight:occluderHash").empty());
}

TEST_F(StrandStage, AReaderHasTheSamePixels)
{
    folder.write("hair.vismap", "mesh = \"hair.tfx\"\nradius = \"0.05:0.01\"\nsamples = 16\n");
    OIIO::ImageBuf map, read(folder / "hair.vismap");
    ASSERT_TRUE(make_image(map, recipe)) << map.geterror();
    ASSERT_TRUE(read.read(0, 0, true, OIIO::TypeFloat)) << read.geterror();
    ASSERT_EQ(map.spec().image_bytes(), read.spec().image_bytes());
    EXPECT_EQ(std::memcmp(map.localpixels(), read.localpixels(), map.spec().image_bytes()), 0);
}

TEST_F(StrandStage, WhatIsOfMeshesAloneIsRefused)
{
    const auto with = [&](const char* key, const char* value) {
        VismapRecipe given = recipe;
        std::string error;
        EXPECT_TRUE(set_param(given, key, value, error)) << error;
        return refused(given);
    };
    for (const auto& [key, value] : std::vector<std::pair<const char*, const char*>> { { "resolution", "64" },
                                                                                       { "unwrap", "true" },
                                                                                       { "material", "Body" },
                                                                                       { "ground", "true" },
                                                                                       { "target_error", "0.1" },
                                                                                       { "reconstruct", "off" },
                                                                                       { "measure", "uniform" },
                                                                                       { "margin", "2" },
                                                                                       { "channels", "normal" },
                                                                                       { "sun_directions", "0,1,0" },
                                                                                       { "effects", "all" },
                                                                                       { "udim", "1002" } })
        EXPECT_EQ(with(key, value), std::string(key) + ": a map of strands does not use it");
    EXPECT_NE(with("basis", "cells").find("strands have no basis cells"), std::string::npos);
    VismapRecipe timed = recipe;
    timed.time_budget = 1;
    EXPECT_EQ(refused(timed), "time_budget: a map of strands does not use it");
    VismapRecipe bare = recipe;
    bare.strand_params.radius.clear();
    EXPECT_NE(refused(bare).find("--radius ROOT:TIP"), std::string::npos);
    VismapRecipe lost = recipe;
    lost.occluder = { folder / "none.obj" };
    EXPECT_NE(refused(lost).find("none.obj"), std::string::npos);
}

TEST_F(StrandStage, ALightmapFiltersTheEnvironmentByTheKernelOfItsMap)
{
    folder.write("hair.vismap", "mesh = \"hair.tfx\"\nradius = \"0.05:0.01\"\nsamples = 16\n");
    LightmapRecipe light;
    light.vismap = folder / "hair.vismap";
    light.environment = folder / "studio.exr";
    light.lightmap_params.model = "ao";
    OIIO::ImageBuf own, given;
    ASSERT_TRUE(make_image(own, light)) << own.geterror();
    folder.write("strand.cfem", "environment = \"studio.exr\"\nkernel = \"strand\"\n");
    light.environment.clear();
    light.cfem = folder / "strand.cfem";
    ASSERT_TRUE(make_image(given, light)) << given.geterror();
    EXPECT_EQ(std::memcmp(own.localpixels(), given.localpixels(), own.spec().image_bytes()), 0);

    light.cfem = folder / "studio.cfem";
    EXPECT_FALSE(make_image(given, light));
    EXPECT_NE(given.geterror().find("makecfem --kernel strand"), std::string::npos);
    light.cfem = folder / "strand.cfem";
    light.bounce_params.bounce = "auto";
    EXPECT_FALSE(make_image(given, light));
    EXPECT_NE(given.geterror().find("a visibility map of strands"), std::string::npos) << given.geterror();
}

TEST_F(StrandStage, AStackForStrandsIsTakenForTheirMapsAlone)
{
    folder.write("hair.vismap", "mesh = \"hair.tfx\"\nradius = \"0.05:0.01\"\nsamples = 16\n");
    LightmapRecipe light;
    light.vismap = folder / "hair.vismap";
    light.environment = folder / "studio.exr";
    OIIO::ImageBuf own, given;
    ASSERT_TRUE(make_image(own, light)) << own.geterror();
    EXPECT_EQ(own.spec().get_string_attribute("vmlight:model"), "lobe");
    folder.write("strand.cfem", "environment = \"studio.exr\"\nkernel = \"strand\"\nstack = true\n");
    light.environment.clear();
    light.cfem = folder / "strand.cfem";
    ASSERT_TRUE(make_image(given, light)) << given.geterror();
    EXPECT_EQ(std::memcmp(own.localpixels(), given.localpixels(), own.spec().image_bytes()), 0);
    light.vismap = folder.write("spot.vismap", "mesh = \"spot.obj\"\nresolution = 16\nsamples = 4\n");
    EXPECT_FALSE(make_image(given, light));
    EXPECT_THAT(given.geterror(), testing::HasSubstr("makecfem --kernel cosine"));
}
