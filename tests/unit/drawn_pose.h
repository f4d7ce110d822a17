// SPDX-License-Identifier: Apache-2.0
/// Another pose of a drawn scene: what of it moves.
#pragma once

#include "drawn_scene.h"

#include <vmlight/trace/occluder.h>
#include <vmlight/uv/raster.h>

#include <OpenImageIO/imagebuf.h>

#include <Imath/ImathBox.h>

#include <array>
#include <cstring>
#include <memory>
#include <random>

namespace vmlight {

/// A rule, which stays one as parts of a scene are taken away. The box around the mesh stays too.
struct DrawnPose
{
    enum Kind
    {
        none, ///< one pose is all
        same, ///< nothing moves
        occluder, ///< the first one moves
        mesh, ///< vertices that are not at the box around the mesh move towards its middle, or away
        both ///< that occluder, and these vertices
    };
    Kind kind = none;
    Imath::V3d shift { 0 }; ///< of an occluder, in sizes of the mesh
    double factor = 1; ///< of distances from the middle

    explicit DrawnPose(uint32_t seed)
    {
        std::mt19937 random(seed + 2000);
        const auto number = [&](double low, double high) { return drawn_surface::number(random, low, high); };
        constexpr std::array kKinds { none, none, none, none, same, occluder, mesh, both };
        kind = kKinds[size_t(drawn_surface::one_of(random, int(kKinds.size())))];
        shift = Imath::V3d { number(-1, 1), number(-1, 1), number(-1, 1) };
        factor = number(0.5, 1.1);
    }

    DrawnScene of(DrawnScene scene) const
    {
        const SceneFrame frame = SceneFrame::around(scene.mesh);
        if ((kind == occluder || kind == both) && !scene.occluders.empty())
            for (Imath::V3d& p : scene.occluders[0].positions)
                p += shift / frame.scale;
        if (kind != mesh && kind != both)
            return scene;
        Imath::Box3d box;
        for (const Imath::V3d& p : scene.mesh.positions)
            box.extendBy(p);
        for (Imath::V3d& p : scene.mesh.positions)
            if (box.min.x < p.x && p.x < box.max.x && box.min.y < p.y && p.y < box.max.y && box.min.z < p.z
                && p.z < box.max.z) {
                const Imath::V3d moved = box.center() + (p - box.center()) * factor;
                if (box.intersects(moved))
                    p = moved;
            }
        return scene;
    }
};

/// Whether two maps of one size have the same bytes in all texels of triangles that are where they were.
inline bool is_same_where_still(const OIIO::ImageBuf& a, const OIIO::ImageBuf& b, const Mesh& before, const Mesh& after)
{
    const int width = a.spec().width, height = a.spec().height;
    const auto bytes = sizeof(float) * size_t(a.nchannels());
    const UvRaster raster(before, width, height);
    const auto cover = std::make_unique<TileCover>(); // the whole map is one tile
    raster.cover(0, *cover);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const uint32_t triangle = cover->triangle[size_t(y * kTileSize + x)];
            if (triangle == TileCover::kNone)
                continue;
            bool is_still = true;
            for (const uint32_t corner : before.triangles[triangle])
                is_still = is_still && before.positions[corner] == after.positions[corner];
            if (!is_still)
                continue;
            const size_t texel = size_t(y * width + x) * size_t(a.nchannels());
            if (std::memcmp(static_cast<const float*>(a.localpixels()) + texel,
                            static_cast<const float*>(b.localpixels()) + texel, bytes)
                != 0)
                return false;
        }
    return true;
}

} // namespace vmlight
