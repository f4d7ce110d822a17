// SPDX-License-Identifier: Apache-2.0
// The fraction of the work that is done, where most of a map is empty or done before.
#include "baked_map.h"
#include "scenes.h"

#include <vmcost/whole_progress.h>

#include <vmlight/reference/reference.h>
#include <vmlight/trace/bake_scene.h>

#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <vector>

using namespace vmlight;
using cost::WholeProgress;

namespace {

// A floor over the lower left sixteenth of the texture: 4 of 64 tiles, in the last two rows, with all of the texels.
Mesh floor_in_a_corner()
{
    Mesh floor = scenes::floor_facing_z(1);
    for (Imath::V2f& uv : floor.uvs)
        uv *= 0.25f;
    return floor;
}

// On one thread a tile is reported when it is done, row by row.
void expect_corner(const std::vector<double>& reported)
{
    EXPECT_TRUE(std::is_sorted(reported.begin(), reported.end()));
    std::vector<double> done(std::upper_bound(reported.begin(), reported.end(), 0.0), reported.end());
    ASSERT_EQ(done.size(), 64u);
    const double all = 64 + 4 * 4096; // a texel each for the tiles, that the last one brings 1
    EXPECT_DOUBLE_EQ(done[47], 48 / all) << "three quarters of the tiles, none of the rays";
    EXPECT_DOUBLE_EQ(done[48], (49 + 4096) / all);
    EXPECT_DOUBLE_EQ(done[49], (50 + 2 * 4096) / all);
    EXPECT_DOUBLE_EQ(done[55], (56 + 2 * 4096) / all);
    EXPECT_DOUBLE_EQ(done[57], (58 + 4 * 4096) / all);
    EXPECT_EQ(done[63], 1);
    EXPECT_LT(done[62], 1);
}

} // namespace

TEST(TileProgress, ABakeReportsTheTexelsThatTrianglesCover)
{
    std::vector<double> reported;
    OIIO::ImageBuf map;
    ASSERT_TRUE(make_vismap(map, floor_in_a_corner(), {}, map_params(512, 512, 1), nullptr, 1, [&](double done) {
        reported.push_back(done);
        return true;
    })) << map.geterror();
    expect_corner(reported);
}

TEST(TileProgress, AReferenceTooReportsTheTexelsThatTrianglesCover)
{
    auto scene = std::make_shared<BakeScene>();
    std::string error;
    ASSERT_TRUE(scene->build(std::make_shared<Mesh>(floor_in_a_corner()), {}, 1, error)) << error;
    OIIO::ImageBuf sky(OIIO::ImageSpec(4, 2, 3, OIIO::TypeFloat)), traced;
    OIIO::ImageBufAlgo::fill(sky, { 1.0f, 1.0f, 1.0f });
    ReferenceParams params;
    params.samples = 2;
    std::vector<double> reported;
    ASSERT_TRUE(make_reference(traced, *scene, sky, map_params(512, 512, 1), {}, params, 1, [&](double done) {
        reported.push_back(done);
        return true;
    })) << traced.geterror();
    expect_corner(reported);
}

TEST(TileProgress, StopsTheBake)
{
    for (const int calls : { 1, 70, 100 }) {
        int left = calls;
        OIIO::ImageBuf map;
        EXPECT_FALSE(make_vismap(map, floor_in_a_corner(), {}, map_params(512, 512, 1), nullptr, 1,
                                 [&](double) { return --left > 0; }));
        EXPECT_EQ(map.geterror(), "interrupted") << calls;
    }
}

TEST(WholeProgress, OneForAllParts)
{
    std::vector<double> reported;
    WholeProgress progress(
        [&](double done) {
            reported.push_back(done);
            return true;
        },
        100);
    progress.skip(20); // known from before
    EXPECT_TRUE(progress.part(40)(0.5));
    progress.skip(20);
    const Progress last = progress.part(20);
    EXPECT_TRUE(last(0));
    EXPECT_TRUE(last(0.5));
    EXPECT_TRUE(last(0.1)); // again
    EXPECT_TRUE(last(1));
    progress.finish();
    const double wanted[] = { 0.999 * 20 / 80, 0.999 * 40 / 60, 0.999 * 50 / 60, 0.999 * 50 / 60, 0.999, 1 };
    ASSERT_EQ(reported.size(), std::size(wanted));
    for (size_t i = 0; i < reported.size(); ++i)
        EXPECT_NEAR(reported[i], wanted[i], 1e-12) << i;
    WholeProgress stopped([](double) { return false; }, 1);
    EXPECT_FALSE(stopped.part(1)(0.5));
}
