// SPDX-License-Identifier: Apache-2.0
// Bounced light on the command line: when it is asked for, what that takes, and what says and keeps it.
#include "bounce_corner.h"

#include <vmlight/base/work_counts.h>

#include <string>

using namespace vmlight;
using testing::HasSubstr;

namespace {

using Bounce = BounceTest;

} // namespace

TEST_F(Bounce, WithoutBeingAskedForItCostsNothing)
{
    const int64_t rays = work_counts().bounce_rays, made = work_counts().bounces_made;
    const int64_t meshes = work_counts().meshes_read;
    done("makevismap corner.vismap -o vm.exr");
    done("makevismap floor.obj --resolution 64 -o open.exr");
    const int64_t baked = work_counts().meshes_read;
    EXPECT_EQ(baked, meshes + 2);
    done("makelightmap vm.exr sky.exr --albedo white.exr -o plain.exr");
    done("makelightmap vm.exr sky.exr --bounce auto --mesh corner.obj -o unasked.exr");
    EXPECT_THAT(done("makelightmap vm.exr sky.exr --albedo black.exr --bounce auto --mesh corner.obj -o black_lit.exr"),
                HasSubstr("bounce: none, as the albedo is 0"));
    EXPECT_THAT(done("makelightmap open.exr sky.exr --albedo white.exr --bounce auto --mesh floor.obj -o open_lit.exr"),
                HasSubstr("bounce: none, as no texel sees a surface"));
    done("makelightmap vm.exr sky.exr --albedo white.exr --bounce auto --effects -bounce -o off.exr");
    EXPECT_EQ(work_counts().bounce_rays, rays);
    EXPECT_EQ(work_counts().bounces_made, made);
    EXPECT_EQ(work_counts().meshes_read, baked);
    expect_same_pixels("plain.exr", "off.exr", 0);
    EXPECT_EQ(attribute("plain.exr", "vmlight:bounce"), "");
}

TEST_F(Bounce, SaysWhyItIsOnOrOff)
{
    const std::string light = "makelightmap corner.vismap sky.exr -o lit.exr --explain ";
    EXPECT_THAT(done(light), HasSubstr("not asked for: --bounce auto adds it"));
    EXPECT_THAT(done(light + "--bounce auto"), HasSubstr("no albedo is given"));
    EXPECT_THAT(done(light + "--bounce auto --albedo white.exr"), HasSubstr("64 rays a texel"));
    EXPECT_EQ(attribute("lit.exr", "vmlight:bounce"), "auto");
    EXPECT_THAT(done(light + "--bounce auto --albedo white.exr --effects -albedo"),
                HasSubstr("the albedo is switched off: surfaces send nothing back"));
    // By its switch alone, as by its key.
    EXPECT_THAT(done(light + "--bounce auto --albedo white.exr"),
                testing::ContainsRegex("took: .*\n  bounce: 0.[0-9]+ M"));
    const Pixels asked = pixels("lit.exr");
    done(light + "--albedo white.exr --effects +bounce --bounce-rays 64");
    EXPECT_EQ(pixels("lit.exr").values, asked.values);
    EXPECT_EQ(attribute("lit.exr", "vmlight:bounce"), "auto");
    refused(2, "+bounce is impossible: no albedo is given", light + "--effects +bounce");
    refused(2, "set --bounce auto", "makelightmap corner.vismap sky.exr -o lit.exr --bounce-rays 32");
}

TEST_F(Bounce, AFileOfTheMapNeedsItsMesh)
{
    done("makevismap shaded.vismap -o vm.exr");
    const std::string light = " sky.exr --albedo white.exr --bounce auto ";
    done("makelightmap shaded.vismap" + light + "-o a.exr");
    done("makelightmap vm.exr" + light + "--mesh floor.obj --occluder wall.obj -o b.exr");
    expect_same_pixels("a.exr", "b.exr", 0);
    refused(1, "does not store its mesh: set --mesh, and --occluder for each mesh that occluded it",
            "makelightmap vm.exr sky.exr --albedo white.exr --bounce on -o c.exr");
    refused(1, "not the mesh that", "makelightmap vm.exr" + light + "--mesh corner.obj --occluder wall.obj -o c.exr");
}

TEST_F(Bounce, ExposureAndFramesKeepWhatIsTraced)
{
    const int64_t before = work_counts().bounce_rays;
    done("makelightmap corner.vismap sky.exr --albedo white.exr --bounce auto -o lit.exr");
    const int64_t once = work_counts().bounce_rays - before;
    EXPECT_GT(once, 0);
    done("makelightmap corner.vismap sky.exr --albedo white.exr --bounce auto --frames 1-5 --rotate-y 0:40 -o f.#.exr");
    EXPECT_EQ(work_counts().bounce_rays - before, 2 * once);
    expect_same_pixels("lit.exr", "f.3.exr", 1e-5f); // of a constant sky
    done("makelightmap corner.vismap sky.exr --albedo white.exr --bounce auto --exposure 2 -o bright.exr");
    const Pixels lit = pixels("lit.exr"), bright = pixels("bright.exr");
    for (size_t i = 0; i < lit.values.size(); ++i)
        ASSERT_NEAR(bright.values[i], 4 * lit.values[i], 1e-5f * bright.values[i]);
}

TEST_F(Bounce, EveryModelHasIt)
{
    done("makelightmap corner.vismap sky.exr --albedo white.exr --bounce auto -o lit.exr");
    for (const char* basis : { "sh", "mask", "cells" }) {
        done(std::string("makevismap corner.vismap --channels normal --basis ") + basis + " -o vm.exr");
        for (const char* model : { "paper", "lobe", "ao", basis }) {
            done(std::string("makelightmap vm.exr sky.exr --mesh corner.obj --albedo white.exr --bounce auto --model ")
                 + model + " -o model.exr");
            for (const int x : { 2, 10, 30, 34, 50, 62 })
                EXPECT_NEAR(value("model.exr", x), value("lit.exr", x), 0.03) << basis << " " << model << " " << x;
        }
    }
}

TEST_F(Bounce, ARecipeKeepsIt)
{
    done("makelightmap corner.vismap sky.exr --albedo white.exr --bounce auto --ground-albedo 0.25 -o hero.lightmap");
    EXPECT_THAT(read("hero.lightmap"), HasSubstr("bounce = \"auto\""));
    EXPECT_THAT(read("hero.lightmap"), HasSubstr("ground_albedo = 0.25"));
    done("makelightmap hero.lightmap -o a.exr");
    done("makelightmap corner.vismap sky.exr --albedo white.exr --bounce auto --ground-albedo 0.25 -o b.exr");
    expect_same_pixels("a.exr", "b.exr", 0);
}
