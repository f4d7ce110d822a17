// SPDX-License-Identifier: Apache-2.0
/// Normal maps: the shading normals of texels, finer than the mesh has them.
#pragma once

#include <vmlight/math/rotation.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/mesh/tangents.h>
#include <vmlight/trace/surface.h>
#include <vmlight/vismap/normal_map_params.h>

#include <OpenImageIO/imagebuf.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// A normal map at the size of a visibility map, ready for its texels.
class NormalMap
{
public:
    /// Decode an image.
    ///
    /// @param image    R and G, or R, G and B, by name or else the first channels; more are ignored. Integers and
    ///                 floats in [0, 1] hold (n + 1) / 2, floats with a value below 0 n itself. Without B, of unit
    ///                 length. Never converted as colour. Resized to `size` by a triangle filter as the components of
    ///                 n, if its size differs
    /// @param warnings set to what is doubtful, one sentence each
    /// @returns false, with the reason in `error`, if the image has one channel (a bump map), a pixel is not finite, or
    ///          most of it are no directions: shorter than 0.7 or longer than 1.3
    bool decode(const OIIO::ImageBuf& image, const NormalMapParams& params, Size size, int nthreads,
                std::vector<std::string>& warnings, std::string& error);

    /// Whether it leaves every normal as it is: a tangent map whose pixels are all within one step of 8 bits of
    /// straight up, in which programs differ.
    bool is_flat() const { return m_is_flat; }
    /// Whether more of a tangent map than a few pixels points into the surface, the last of the warnings: maybe it is
    /// in object space.
    bool points_inwards() const { return m_points_inwards; }
    /// Whether its normals stay as they are when the surface turns.
    bool is_object_space() const { return m_is_object_space; }

    /// Multiply x and y of a tangent map, as glTF's `scale` does.
    void scale(float lean);
    /// Become the tangent map of a mesh whose materials have maps of their own: straight up, but for the texels that
    /// take() is called for. After the last, settle().
    void reset(Size size);
    /// Take those texels of `part`, of the same size, for which `chosen`, row by row, is `choice`.
    void take(const NormalMap& part, const std::vector<uint32_t>& chosen, uint32_t choice);
    void settle();

    /// Make the tangents of `mesh`, if the map needs them. Call before map_normal().
    void attach(std::shared_ptr<const Mesh> mesh);

    /// Whether both give every texel the same normal on the same mesh.
    bool is_same_image(const NormalMap& other) const;
    /// Equal if they do, the same on every little-endian machine.
    uint64_t hash() const;
    /// Whether the normals of a triangle are those that `base` has in another pose of the mesh, turned: tangents also
    /// turn with neighbours. Both are attached.
    /// @param exactly  to the last bit, as what stands still
    bool is_turned(const NormalMap& base, uint32_t triangle, const Rotation& turn, bool exactly) const;

    /// Set the normal of `point`, the centre of texel (x, y), where weights are those of the triangle's second and
    /// third corners. It stays where the map gives no direction.
    void apply(SurfacePoint& point, uint32_t triangle, float weight1, float weight2, int x, int y) const;

private:
    bool m_is_flat = true, m_is_object_space = false, m_points_inwards = false;
    int m_width = 0;
    std::vector<Imath::V3f> m_normals;
    std::shared_ptr<const Mesh> m_mesh;
    std::vector<std::array<CornerTangent, 3>> m_tangents;
};

using NormalMapPointer = std::shared_ptr<const NormalMap>;

} // namespace vmlight
