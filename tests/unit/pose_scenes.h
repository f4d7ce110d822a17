// SPDX-License-Identifier: Apache-2.0
/// Meshes that deform: a door, a flag, a skin; and what bakes their poses.
#pragma once

#include "scenes.h"

#include <vmlight/math/rotation.h>
#include <vmlight/vismap/pose_sequence.h>
#include <vmlight/vismap/vismap.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace vmlight::scenes {

/// A sheet of `across` x `down` quads through point(u, v), u and v from 0 to 1, smooth, over a rectangle of the
/// texture. The side from which u, v are counter-clockwise is seen.
inline void add_sheet(Mesh& mesh, int across, int down, const std::function<V3d(double u, double v)>& point, V2f uv0,
                      V2f uv1)
{
    const auto first = uint32_t(mesh.positions.size());
    constexpr double kStep = 1e-4;
    for (int j = 0; j <= down; ++j)
        for (int i = 0; i <= across; ++i) {
            const double u = double(i) / across, v = double(j) / down;
            const V3d along = point(u + kStep, v) - point(u - kStep, v), up = point(u, v + kStep) - point(u, v - kStep);
            mesh.positions.push_back(V3d(V3f(point(u, v)))); // as a file has it
            mesh.normals.push_back(V3f(along.cross(up).normalized()));
            mesh.uvs.push_back(V2f(uv0.x + (uv1.x - uv0.x) * float(u), uv0.y + (uv1.y - uv0.y) * float(v)));
        }
    for (int j = 0; j < down; ++j)
        for (int i = 0; i < across; ++i) {
            const uint32_t a = first + uint32_t(j * (across + 1) + i), b = a + 1, d = a + uint32_t(across) + 1;
            mesh.triangles.push_back({ a, b, d + 1 });
            mesh.triangles.push_back({ a, d + 1, d });
        }
    mesh.triangle_materials.assign(mesh.triangles.size(), 0);
}

/// A floor of 12 x 12 that faces +y, a wall across it, and in the wall a door of 1 x 1.5, opened by `degrees`. The box
/// around them is the same for every angle.
inline Mesh door(double degrees)
{
    Mesh mesh;
    mesh.name = "door";
    const auto flat
        = [](V3d corner, V3d along, V3d up) { return [=](double u, double v) { return corner + along * u + up * v; }; };
    add_sheet(mesh, 12, 12, flat(V3d(-6, 0, 6), V3d(12, 0, 0), V3d(0, 0, -12)), V2f(0.01f, 0.01f), V2f(0.74f, 0.74f));
    // Both sides of the wall, left and right of the door.
    float at = 0.01f;
    for (const double left : { -6.0, 1.0 }) {
        const double width = left < 0 ? 6 : 5;
        add_sheet(mesh, 4, 2, flat(V3d(left, 0, 0.05), V3d(width, 0, 0), V3d(0, 1.5, 0)), V2f(at, 0.76f),
                  V2f(at + 0.22f, 0.86f));
        add_sheet(mesh, 4, 2, flat(V3d(left + width, 0, -0.05), V3d(-width, 0, 0), V3d(0, 1.5, 0)),
                  V2f(at + 0.24f, 0.76f), V2f(at + 0.46f, 0.86f));
        at += 0.49f;
    }
    const double angle = degrees * M_PI / 180;
    const V3d along(std::cos(angle), 0, std::sin(angle)), out(-std::sin(angle), 0, std::cos(angle)), hinge(0, 0, 0);
    add_sheet(mesh, 2, 3, flat(hinge + out * 0.03, along, V3d(0, 1.5, 0)), V2f(0.76f, 0.01f), V2f(0.86f, 0.16f));
    add_sheet(mesh, 2, 3, flat(hinge + along - out * 0.03, -along, V3d(0, 1.5, 0)), V2f(0.88f, 0.01f),
              V2f(0.98f, 0.16f));
    return mesh;
}

/// A house of three walls and a roof on a lawn, and a flag on a pole beside it that waves: `time` from 0 to 1 is one
/// wave.
inline Mesh flag(double time)
{
    Mesh mesh;
    mesh.name = "flag";
    const auto flat
        = [](V3d corner, V3d along, V3d up) { return [=](double u, double v) { return corner + along * u + up * v; }; };
    add_sheet(mesh, 16, 16, flat(V3d(-8, 0, 8), V3d(16, 0, 0), V3d(0, 0, -16)), V2f(0.01f, 0.01f), V2f(0.7f, 0.7f));
    add_sheet(mesh, 6, 4, flat(V3d(-4, 0, 2), V3d(4, 0, 0), V3d(0, 3, 0)), V2f(0.01f, 0.72f), V2f(0.24f, 0.98f));
    add_sheet(mesh, 6, 4, flat(V3d(0, 0, 2), V3d(0, 0, -4), V3d(0, 3, 0)), V2f(0.26f, 0.72f), V2f(0.48f, 0.98f));
    add_sheet(mesh, 6, 4, flat(V3d(0, 0, -2), V3d(-4, 0, 0), V3d(0, 3, 0)), V2f(0.5f, 0.72f), V2f(0.72f, 0.98f));
    add_sheet(mesh, 6, 4, flat(V3d(-4, 3, 2), V3d(4, 0, 0), V3d(0, 0, -4)), V2f(0.74f, 0.72f), V2f(0.98f, 0.98f));
    const auto cloth = [time](double u, double v) {
        const double wave = 0.25 * u * std::sin(2 * M_PI * (1.5 * u - time));
        return V3d(3 + 1.5 * u, 3 + v, wave);
    };
    add_sheet(mesh, 24, 12, cloth, V2f(0.72f, 0.01f), V2f(0.84f, 0.1f));
    add_sheet(
        mesh, 24, 12, [&](double u, double v) { return cloth(1 - u, v) + V3d(0, 0, -0.01); }, V2f(0.86f, 0.01f),
        V2f(0.98f, 0.1f));
    return mesh;
}

/// A ball with dents all over, which breathe by `depth` of its radius.
inline Mesh skin(double depth)
{
    Mesh mesh;
    mesh.name = "skin";
    const auto point = [depth](double u, double v) {
        const double phi = 2 * M_PI * u, theta = M_PI * (0.06 + 0.88 * v);
        const double radius = 1 + (0.12 + depth) * std::sin(6 * phi) * std::sin(7 * theta);
        return V3d(std::sin(theta) * std::cos(phi), -std::cos(theta), -std::sin(theta) * std::sin(phi)) * radius;
    };
    add_sheet(mesh, 96, 64, point, V2f(0.01f, 0.01f), V2f(0.99f, 0.99f));
    return mesh;
}

/// Turned, then moved, and rounded as a file rounds.
inline Mesh moved(Mesh mesh, const Rotation& turn, V3d shift)
{
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        mesh.positions[i] = V3d(V3f(rotate(turn, mesh.positions[i]) + shift));
        mesh.normals[i] = V3f(rotate(turn, V3d(mesh.normals[i])));
    }
    return mesh;
}

/// A map in memory, all channels.
struct PoseMap
{
    OIIO::ImageBuf image;
    VismapReport report;
    PoseReport pose;

    const float* at(int x, int y) const { return static_cast<const float*>(image.pixeladdr(x, y)); }
    float coverage(int x, int y) const { return at(x, y)[image.nchannels() - 1]; }
    /// visit(x, y) for each covered texel; the map must have the channel `coverage`.
    template <class Visit> void each_covered(const Visit& visit) const
    {
        for (int y = 0; y < image.spec().height; ++y)
            for (int x = 0; x < image.spec().width; ++x)
                if (coverage(x, y) == 1)
                    visit(x, y);
    }
    bool has_bytes_of(const PoseMap& other) const
    {
        const size_t bytes = image.spec().image_bytes();
        return bytes == other.image.spec().image_bytes()
            && std::memcmp(image.localpixels(), other.image.localpixels(), bytes) == 0;
    }
};

inline VismapParams pose_params(int side, int samples)
{
    VismapParams params;
    params.resolution = { side, side };
    params.samples = samples;
    params.margin = 2;
    params.channels = { "coverage" };
    params.reconstruct = "off"; // what is tested is which rays are traced again
    return params;
}

inline BakeScenePointer scene_of(const Mesh& mesh, const std::vector<Mesh>& occluders = {})
{
    const auto scene = std::make_shared<BakeScene>();
    std::string error;
    EXPECT_TRUE(scene->build(std::make_shared<const Mesh>(mesh), occluders, 1, error)) << error;
    return scene;
}

/// Of V, that poses of a sequence may be off by.
constexpr double kSequenceError = 0.01;

/// The next pose.
inline std::unique_ptr<PoseMap> bake_pose(PoseSequence& sequence, const BakeScenePointer& scene,
                                          const VismapParams& params, const std::string& name, int nthreads = 0)
{
    auto map = std::make_unique<PoseMap>();
    EXPECT_TRUE(sequence.bake(map->image, { scene, params, nthreads, {}, 0, nullptr }, name, &map->report))
        << map->image.geterror();
    map->pose = sequence.last();
    return map;
}

/// As without other poses.
inline std::unique_ptr<PoseMap> bake_alone(const BakeScenePointer& scene, const VismapParams& params)
{
    auto map = std::make_unique<PoseMap>();
    EXPECT_TRUE(make_vismap(map->image, scene, params, &map->report, 0, {})) << map->image.geterror();
    return map;
}

/// Share of the covered texels whose V differs by more than `limit`.
inline double share_beyond(const PoseMap& a, const PoseMap& b, double limit)
{
    double beyond = 0, all = 0;
    a.each_covered([&](int x, int y) {
        ++all;
        beyond += std::abs(a.at(x, y)[0] - b.at(x, y)[0]) > limit;
    });
    return beyond / all;
}

} // namespace vmlight::scenes
