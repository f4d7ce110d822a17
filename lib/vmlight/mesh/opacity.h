// SPDX-License-Identifier: Apache-2.0
/// How opaque a mesh is, point by point, by the alpha of its materials: one rule for the bake and for frames.
#pragma once

#include <vmlight/mesh/alpha_texture.h>
#include <vmlight/mesh/material.h>
#include <vmlight/mesh/mesh.h>

#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace vmlight {

/// The share of light that a surface stops, from 0 to 1: `mask` is all or nothing, all where alpha is at least the
/// cutoff; `blend` is alpha. Alpha that is not a number is 1.
/// Source: Khronos, glTF 2.0 specification, 3.9.4 (alpha coverage).
inline double opacity_of(AlphaMode mode, double alpha, double cutoff)
{
    if (mode == AlphaMode::opaque || alpha != alpha)
        return 1;
    if (mode == AlphaMode::mask)
        return alpha >= cutoff ? 1 : 0;
    return alpha < 0 ? 0 : alpha > 1 ? 1 : alpha;
}

/// The alpha of one material: `factor` times its textures.
struct MaterialOpacity
{
    struct Texture
    {
        /// nullptr: none.
        std::shared_ptr<const AlphaTexture> image;
        /// As in MaterialTexture.
        Imath::M33d uv_transform;
        int uv_set = 0;

        bool operator==(const Texture& other) const
        {
            return (image && other.image ? *image == *other.image : image == other.image)
                && uv_transform == other.uv_transform && uv_set == other.uv_set;
        }
    };

    AlphaMode mode = AlphaMode::opaque;
    double cutoff = 0.5;
    /// In [0, 1].
    double factor = 1;
    /// Those that are there come first.
    std::array<Texture, 2> textures;

    bool operator==(const MaterialOpacity& other) const
    {
        return mode == other.mode && cutoff == other.cutoff && factor == other.factor && textures == other.textures;
    }

    bool operator!=(const MaterialOpacity& other) const { return !(*this == other); }

    /// Whether no point, whatever its texture coordinates, lets light through.
    bool is_opaque() const;
};

/// What of a mesh is not opaque. Held by Mesh::opacity.
struct MeshOpacity
{
    /// For each of the mesh's materials.
    std::vector<MaterialOpacity> materials;
    /// For each UV set that they ask for, three uvs a triangle. Sets that are not there are those of the mesh.
    std::vector<std::vector<Imath::V2f>> uvs;
};

/// The uvs that a texture is looked up by, of a triangle's corners. NaN where it has none.
std::array<Imath::V2f, 3> texture_uvs(const Mesh& mesh, uint32_t triangle, const MaterialOpacity::Texture& texture);

/// Opacity over one triangle, by the barycentric weights u and v of its second and third corners. A texture whose uvs
/// are not finite at a corner, or beyond 1e100, counts as 1, as where there is none.
class TriangleOpacity
{
public:
    /// @param material must outlive this
    /// @param uvs      of each texture of `material` that is there
    TriangleOpacity(const MaterialOpacity& material, const std::array<std::array<Imath::V2f, 3>, 2>& uvs);

    /// Opacity at a point of the triangle.
    double at(double u, double v) const;
    /// The least and greatest opacity in the part of the triangle between three points (u, v): at() is nowhere in it
    /// outside of them, though it may not reach them.
    AlphaRange range(const std::array<Imath::V2d, 3>& corners) const;
    /// Whether all points of the triangle have the same.
    bool is_constant() const;
    /// The longest edge in the textures, in texels; 0 without textures.
    double longest_edge() const;

private:
    struct Layer
    {
        const AlphaTexture* image;
        Imath::V2d start, along_u, along_v;
        /// More than the rounding of what is computed from them.
        Imath::V2d slack;

        Imath::V2d at(double u, double v) const { return start + along_u * u + along_v * v; }
    };

    const MaterialOpacity& m_material;
    std::array<Layer, 2> m_layers;
    int m_count = 0;
};

/// The part of `opacity` for the chosen triangles of its mesh.
std::shared_ptr<const MeshOpacity> opacity_part(const MeshOpacity& opacity, const std::vector<size_t>& triangles);

} // namespace vmlight
