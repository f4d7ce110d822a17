// SPDX-License-Identifier: Apache-2.0
/// What is baked, the error that a bake says it has, and the one it has.
#pragma once

#include "baked_map.h"
#include "scenes.h"

#include <vmlight/mesh/import/read_mesh.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace vmlight::scenes {

/// How far, of itself, the error that is said may be from the true one. Worst of the scenes, measured: 5 %, most of it
/// chance, since both errors are of some thousand texels.
constexpr double kHonest = 0.1;

struct BakeInput
{
    Mesh mesh;
    std::vector<Mesh> occluders;
};

/// A file of tests/data.
inline Mesh test_mesh(const std::string& name)
{
    Mesh mesh;
    std::string error;
    EXPECT_TRUE(read_mesh(mesh, VMLIGHT_TEST_DATA "/" + name, {}, error)) << error;
    return mesh;
}

inline BakeInput ball_over_floor()
{
    return { floor_facing_z(1), { sphere(V3d(0.2, 0.1, 0.7), 0.4, 24) } };
}

inline BakeInput spot()
{
    return { test_mesh("spot.obj"), {} };
}

inline BakeInput spot_on_the_ground()
{
    BakeInput scene = spot();
    double low = 1e9;
    for (const V3d& p : scene.mesh.positions)
        low = std::min(low, p.y);
    scene.occluders.push_back(rectangle(V3d(-5, low, 5), V3d(10, 0, 0), V3d(0, 0, -10)));
    return scene;
}

/// Channels V, direction, error and coverage, in that order.
inline VismapParams error_params(int side, int samples, const std::string& sampler = "fibonacci")
{
    VismapParams params = map_params(side, side, samples, sampler);
    params.channels = { "coverage", "error" };
    return params;
}

/// The same, each texel averaged with its neighbours.
inline VismapParams reconstruct_params(int side, int samples)
{
    VismapParams params = error_params(side, samples);
    params.reconstruct = "auto";
    return params;
}

/// Root mean square over the covered texels of `texel`, which is given V, the channel error, and the place.
inline double rms(const BakedMap& map, const std::function<double(const float* texel, int x, int y)>& value)
{
    double sum = 0, count = 0;
    float texel[6];
    for (int y = 0; y < map.spec().height; ++y)
        for (int x = 0; x < map.spec().width; ++x) {
            map.image().getpixel(x, y, 0, texel, 6);
            if (texel[5] == 1) {
                sum += std::pow(value(texel, x, y), 2);
                ++count;
            }
        }
    return std::sqrt(sum / count);
}

inline double channel_rms(const BakedMap& map)
{
    return rms(map, [](const float* texel, int, int) { return texel[4]; });
}

/// Against reference_of(): 16 times the rays, from another seed, with an eighth of the error where that falls as
/// N^-0.75 (a quarter at the worst, as of chance). Squares add up: that adds .8 percent (3 at the worst).
inline double true_rms(const BakedMap& map, const BakedMap& reference)
{
    return rms(map, [&](const float* texel, int x, int y) { return texel[0] - reference.at(x, y).visibility; });
}

inline BakedMap reference_of(const BakeInput& scene, int side, int samples)
{
    VismapParams params = map_params(side, side, 16 * samples);
    params.seed = 1234;
    return BakedMap(scene.mesh, scene.occluders, params);
}

} // namespace vmlight::scenes
