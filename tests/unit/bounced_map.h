// SPDX-License-Identifier: Apache-2.0
/// Maps with bounced light, and how far they are from brute force.
#pragma once

#include "bounce_oracle.h"
#include "scenes.h"

#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/light_transport.h>
#include <vmlight/vismap/normal_map.h>
#include <vmlight/vismap/point_visibility.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace vmlight::scenes {

inline VismapParams bounce_map_of(int width, int height = 0)
{
    VismapParams map;
    map.resolution = { width, height ? height : width };
    map.margin = 0;
    map.samples = 1024;
    return map;
}

/// A map of a scene lit by a sky of 1, of which V is the light, and what bounces.
class Bounced
{
public:
    Bounced(const Mesh& mesh, const std::vector<Mesh>& occluders, const VismapParams& the_map,
            TransportParams params = {}, int nthreads = 0, const NormalMapPointer& normals = nullptr)
        : map(the_map)
        , m_nthreads(nthreads)
    {
        std::string error;
        OIIO::ImageBuf image;
        auto built = std::make_shared<BakeScene>();
        SceneChoice choice = SceneChoice::within(map.max_distance);
        choice.cull = false;
        EXPECT_TRUE(built->build(std::make_shared<Mesh>(mesh), occluders, nthreads, error, choice)) << error;
        scene = built;
        EXPECT_TRUE(make_vismap(image, scene, map, nullptr, nthreads, {}, 0, normals)) << image.geterror();
        visibility.resize(size_t(image.spec().image_pixels()));
        OIIO::ROI first = image.roi();
        first.chend = 1;
        EXPECT_TRUE(image.get_pixels(first, OIIO::TypeFloat, visibility.data()));
        EXPECT_TRUE(transport.prepare(scene, map, visibility, params, error, nthreads, {}, normals)) << error;
    }

    /// With `albedo` of the map, and of each of the points off it.
    std::vector<float> gather(float albedo, const std::function<float(const LightPoint&)>& of_point = {}) const
    {
        std::vector<float> own, baked, points, light;
        for (const float v : visibility)
            own.insert(own.end(), 3, albedo * v);
        EXPECT_TRUE(bake_points(baked, *scene, map, transport.surfaces(), m_nthreads));
        const size_t channels = point_channels(map).size();
        for (size_t i = 0; i < transport.points().size(); ++i)
            points.insert(points.end(), 3, (of_point ? of_point(transport.points()[i]) : albedo) * baked[i * channels]);
        EXPECT_TRUE(transport.gather(light, own, points, m_nthreads));
        return light;
    }

    VismapParams map;
    BakeScenePointer scene;
    std::vector<float> visibility;
    LightTransport transport;

private:
    int m_nthreads;
};

/// A floor and a wall, each 1 wide and 80 long, that meet at a right angle.
inline Mesh corner()
{
    Mesh mesh;
    mesh.name = "corner";
    add_quad(mesh, V3d(0, -40, 0), V3d(1, -40, 0), V3d(1, 40, 0), V3d(0, 40, 0), V2f(0, 0), V2f(0.5f, 1));
    add_quad(mesh, V3d(0, 40, 0), V3d(0, 40, 1), V3d(0, -40, 1), V3d(0, -40, 0), V2f(0.5f, 0), V2f(1, 1));
    return mesh;
}

/// Root mean square of what the oracle and the library differ by, relative to the mean of the bounced light.
inline double error_of(const std::vector<float>& light, const std::vector<oracle::Place>& places, oracle::Bounce truth,
                       int step)
{
    double squares = 0, all = 0, count = 0;
    for (size_t i = 0; i < places.size(); i += size_t(step)) {
        if (!places[i].exists)
            continue;
        const double wanted = truth.bounced(places[i].position, places[i].normal, 28, 6);
        squares += std::pow(double(light[3 * i]) - wanted, 2);
        all += wanted;
        ++count;
    }
    EXPECT_GT(count, 50);
    return std::sqrt(squares / count) / (all / count);
}

/// Of error_of(): 64 rays a texel, and the noise of the oracle.
constexpr double kRmsOfBounce = 0.08;

inline double constant_sky(const V3d&)
{
    return 1;
}

} // namespace vmlight::scenes
