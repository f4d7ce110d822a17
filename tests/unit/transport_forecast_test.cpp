// SPDX-License-Identifier: Apache-2.0
// What light transport takes is known before it is traced.
#include "bounced_map.h"
#include "cases.h"

#include <vmlight/base/work_counts.h>
#include <vmlight/vismap/transport_forecast.h>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

// A corner on the ground, with an occluder: nearly all points that light it are off the map.
Bounced on_ground(int size)
{
    VismapParams map = bounce_map_of(size);
    map.samples = 64;
    map.ground = true;
    map.ground_height = -60;
    TransportParams params;
    params.ground = true;
    return { corner(), { rectangle(V3d(0.2, -40, 0.5), V3d(0, 80, 0), V3d(0.3, 0, 0.1)) }, map, params };
}

TransportForecast forecast_of(const Bounced& bounced, int threads)
{
    TransportForecast forecast;
    TransportParams params;
    params.ground = bounced.map.ground;
    EXPECT_TRUE(
        forecast_transport(forecast, bounced.scene, bounced.map, bounced.visibility, params, threads, {}, nullptr));
    return forecast;
}

} // namespace

// But for the few rays that are traced again.
TEST(TransportForecast, IsExactForSmallMaps)
{
    const Bounced bounced = on_ground(48);
    const TransportForecast forecast = forecast_of(bounced, 1);
    const double rays = double(bounced.transport.rays()), points = double(bounced.transport.points().size());
    EXPECT_NEAR(forecast.rays, rays, 0.1 * rays);
    EXPECT_NEAR(forecast.points, points, 0.01 * points);
    EXPECT_EQ(forecast_of(bounced, 4).points, forecast.points);
}

TEST(TransportForecast, IsNearTheTruthForLargerOnes)
{
    for (int size = 192; size <= cases(320, 192); size += 128) {
        const Bounced bounced = on_ground(size);
        const TransportForecast forecast = forecast_of(bounced, 0);
        const double rays = double(bounced.transport.rays()), points = double(bounced.transport.points().size());
        EXPECT_NEAR(forecast.rays, rays, 0.1 * rays) << size;
        EXPECT_GT(forecast.points, points / 1.5) << size;
        EXPECT_LT(forecast.points, points * 1.5) << size;
    }
}

TEST(TransportForecast, OfNothingIsNothing)
{
    const Bounced bounced(floor_facing_z(1), {}, bounce_map_of(32));
    const TransportForecast forecast = forecast_of(bounced, 1);
    EXPECT_EQ(forecast.rays, 0);
    EXPECT_EQ(forecast.points, 0);
}
