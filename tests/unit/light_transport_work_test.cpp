// SPDX-License-Identifier: Apache-2.0
// Bounced light: what it traces, keeps and refuses.
#include "bounced_map.h"

#include <vmlight/base/work_counts.h>

using namespace vmlight;
using namespace vmlight::scenes;

TEST(LightTransport, WhereNothingIsInTheWayNoRayIsTraced)
{
    const int64_t before = work_counts().bounce_rays;
    for (const Mesh& mesh : { floor_facing_z(1), box(V3d(-1), V3d(1), false) }) {
        const Bounced bounced(mesh, {}, bounce_map_of(32));
        EXPECT_EQ(bounced.transport.rays(), 0);
        EXPECT_TRUE(bounced.transport.points().empty());
        for (const float value : bounced.gather(1))
            ASSERT_EQ(value, 0);
    }
    EXPECT_EQ(work_counts().bounce_rays, before);
}

TEST(LightTransport, OtherLightNeedsNoRay)
{
    const Bounced bounced(corner(), { rectangle(V3d(0.2, -40, 0.5), V3d(0, 80, 0), V3d(0.3, 0, 0.1)) },
                          bounce_map_of(32));
    EXPECT_TRUE(bounced.transport.is_kept());
    EXPECT_GT(bounced.transport.rays(), 0);
    const int64_t before = work_counts().bounce_rays;
    const std::vector<float> once = bounced.gather(1), half = bounced.gather(0.5f);
    EXPECT_EQ(work_counts().bounce_rays, before);
    for (size_t i = 0; i < once.size(); ++i)
        ASSERT_NEAR(half[i], 0.5f * once[i], 1e-6f);
}

TEST(LightTransport, ShortMemoryAndThreadsChangeNoBit)
{
    const std::vector<Mesh> occluders { rectangle(V3d(0.2, -40, 0.5), V3d(0, 80, 0), V3d(0.3, 0, 0.1)) };
    VismapParams map = bounce_map_of(150, 90);
    map.margin = 3;
    map.samples = 64;
    map.ground = true;
    map.ground_height = -60;
    TransportParams params;
    params.ground = true;
    const std::vector<float> one = Bounced(corner(), occluders, map, params, 1).gather(0.7f);
    EXPECT_EQ(Bounced(corner(), occluders, map, params, 4).gather(0.7f), one);
    params.most_bytes = 0;
    const Bounced unkept(corner(), occluders, map, params, 4);
    const int64_t before = work_counts().bounce_rays;
    EXPECT_FALSE(unkept.transport.is_kept());
    EXPECT_EQ(unkept.gather(0.7f), one);
    EXPECT_GT(work_counts().bounce_rays, before);
}

TEST(LightTransport, RefusesWhatItCannotTrace)
{
    const Mesh floor = floor_facing_z(1);
    std::string error;
    auto scene = std::make_shared<BakeScene>();
    ASSERT_TRUE(scene->build(non_owning(floor), {}, 0, error)) << error;
    LightTransport transport;
    TransportParams params;
    params.rays = 500;
    EXPECT_FALSE(transport.prepare(scene, bounce_map_of(16), {}, params, error));
    EXPECT_EQ(error, "500 rays; 8 to 248 are allowed");
    params.rays = 8;
    EXPECT_FALSE(transport.prepare(scene, bounce_map_of(16), {}, params, error, 1, [](double) { return false; }));
    EXPECT_EQ(error, "interrupted");
    EXPECT_TRUE(transport.prepare(scene, bounce_map_of(16), {}, params, error)) << error;
    EXPECT_EQ(transport.rays(), 16 * 16 * 8); // nothing is known of what is open
}
