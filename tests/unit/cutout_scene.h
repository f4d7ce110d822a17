// SPDX-License-Identifier: Apache-2.0
/// Meshes with cut-outs in memory, without files.
#pragma once

#include "scenes.h"

#include <vmlight/mesh/opacity.h>

#include <functional>
#include <memory>
#include <random>
#include <vector>

namespace vmlight::cutout_scene {

using Imath::V2d;
using Imath::V2f;
using Imath::V3d;
using Imath::V3f;

using AlphaPointer = std::shared_ptr<const AlphaTexture>;

inline AlphaPointer texture(int width, int height, const std::function<float(int x, int y)>& alpha,
                            TextureWrap wrap_s = TextureWrap::periodic, TextureWrap wrap_t = TextureWrap::periodic,
                            bool is_nearest = false)
{
    std::vector<float> texels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            texels.push_back(alpha(x, y));
    return std::make_shared<AlphaTexture>(width, height, std::move(texels), wrap_s, wrap_t, is_nearest);
}

/// Open and closed fields, the first of them closed.
inline AlphaPointer checker(int side)
{
    return texture(side, side, [](int x, int y) { return float((x + y + 1) % 2); });
}

/// A leaf: an ellipse, soft at its border, with bites.
inline AlphaPointer leaf(int side)
{
    return texture(side, side, [&](int x, int y) {
        const double s = (x + 0.5) / side * 2 - 1, t = (y + 0.5) / side * 2 - 1;
        const double r = std::hypot(s, t * 1.4) + 0.08 * std::sin(9 * std::atan2(t, s));
        return float(std::min(1.0, std::max(0.0, (0.8 - r) * side / 8 + 0.5)));
    });
}

inline MaterialOpacity material(AlphaMode mode, const AlphaPointer& alpha, double factor = 1, double cutoff = 0.5)
{
    MaterialOpacity result;
    result.mode = mode;
    result.factor = factor;
    result.cutoff = cutoff;
    result.textures[0].image = alpha;
    return result;
}

/// All of a mesh has one material.
inline Mesh with_material(Mesh mesh, const MaterialOpacity& material)
{
    auto opacity = std::make_shared<MeshOpacity>();
    opacity->materials = { material };
    mesh.materials.resize(1);
    mesh.triangle_materials.assign(mesh.triangles.size(), 0);
    mesh.opacity = std::move(opacity);
    return mesh;
}

/// A square of side 2 `half` at a height, its texture `repeats` times across.
inline Mesh card(double half, double height, double repeats = 1)
{
    Mesh mesh;
    mesh.name = "card";
    const double h = half;
    scenes::add_quad(mesh, V3d(-h, -h, height), V3d(h, -h, height), V3d(h, h, height), V3d(-h, h, height), V2f(0, 0),
                     V2f(float(repeats), float(repeats)));
    return mesh;
}

/// Cards at random, each with the whole texture, above a floor of side 2.
inline Mesh foliage(int cards, unsigned seed)
{
    Mesh mesh;
    mesh.name = "foliage";
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> in(-1, 1);
    for (int i = 0; i < cards; ++i) {
        const V3d middle(in(random), in(random), 0.6 + 0.5 * in(random));
        const V3d along = V3d(in(random), in(random), in(random)).normalized() * 0.15;
        const V3d side = along.cross(V3d(in(random), in(random), in(random))).normalized() * 0.15;
        scenes::add_quad(mesh, middle - along - side, middle + along - side, middle + along + side,
                         middle - along + side, V2f(0, 0), V2f(1, 1));
    }
    return mesh;
}

} // namespace vmlight::cutout_scene
