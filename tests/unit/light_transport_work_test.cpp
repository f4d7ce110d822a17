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

TEST(LightTransport, MemoryIsCounted)
{
    const std::vector<Mesh> occluders { rectangle(V3d(0.2, -40, 0.5), V3d(0, 80, 0), V3d(0.3, 0, 0.1)) };
    const Bounced whole(corner(), occluders, bounce_map_of(64));
    LightTransport transport;
    TransportParams params;
    std::string error;
    const auto prepare = [&](size_t memory, size_t kept) {
        params.memory = memory;
        params.most_bytes = kept;
        error.clear();
        return transport.prepare(whole.scene, whole.map, whole.visibility, params, error);
    };
    EXPECT_FALSE(prepare(1000, 1 << 30));
    EXPECT_NE(error.find("bounced light of 64x64 texels needs 192 KB of memory"), std::string::npos) << error;
    // Enough for the texels, and not for cells: also where nothing else is kept.
    EXPECT_FALSE(prepare(64 * 64 * 48 + 1000, 0));
    EXPECT_NE(error.find("needs more than"), std::string::npos) << error;
    EXPECT_TRUE(transport.points().empty());
    EXPECT_EQ(transport.bytes(), 0u);
    EXPECT_TRUE(prepare(size_t(64) << 20, 1 << 30)) << error;
    EXPECT_EQ(transport.bytes(), whole.transport.bytes());
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
    EXPECT_EQ(error, "rays: 500 is not in [8, 248]");
    params.rays = 8;
    EXPECT_FALSE(transport.prepare(scene, bounce_map_of(16), {}, params, error, 1, [](double) { return false; }));
    EXPECT_EQ(error, "interrupted");
    EXPECT_TRUE(transport.prepare(scene, bounce_map_of(16), {}, params, error)) << error;
    EXPECT_EQ(transport.rays(), 16 * 16 * 8); // nothing is known of what is open
    std::vector<float> light { 1 };
    EXPECT_FALSE(transport.gather(light, std::vector<float>(3 * 16 * 15), {}));
    EXPECT_TRUE(light.empty());
    EXPECT_FALSE(transport.gather(light, std::vector<float>(3 * 16 * 16), std::vector<float>(3)));
    EXPECT_TRUE(transport.gather(light, std::vector<float>(3 * 16 * 16), {}));
    EXPECT_FALSE(transport.prepare(scene, bounce_map_of(16), std::vector<float>(15 * 16), params, error));
    EXPECT_EQ(error, "240 values of visibility for 16x16 texels");
    EXPECT_FALSE(transport.gather(light, std::vector<float>(3 * 16 * 16), {}));
    EXPECT_EQ(transport.bytes(), 0u);
}
