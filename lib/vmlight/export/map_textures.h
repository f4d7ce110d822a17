// SPDX-License-Identifier: Apache-2.0
/// Textures for engines from the V and B of a visibility map.
#pragma once

#include <vmlight/export/texel_surface.h>

#include <Imath/ImathVec.h>
#include <OpenImageIO/imagebuf.h>

#include <cstdint>
#include <string>
#include <vector>

namespace vmlight {

/// V and B of a map, texel by texel, and what is known of its surface.
class MapTexels
{
public:
    /// @param map      a visibility map of floats in memory; kept no longer
    /// @param surface  of the same size, or nullptr: must outlive it
    /// @returns false, with the reason in `error`, if it is no visibility map of a surface, a value of V or B is not
    ///          finite, or its display window is not what is stored
    bool open(const OIIO::ImageBuf& map, const TexelSurface* surface, std::string& error);

    int width() const { return m_width; }
    int height() const { return m_height; }

    /// V and B of each texel, four channels. Around the charts it is that of their borders, everywhere, if the charts
    /// are known: from the surface, or the map's channel `coverage`. Else texels where the map has nothing stay 0, as
    /// closed ones do.
    OIIO::ImageBuf filled_map() const;
    /// Its V, one channel, in [0, 1].
    OIIO::ImageBuf occlusion() const;
    /// The shading normal of each texel, three channels, filled in the same way: the map's, if it has the channels,
    /// else that of the mesh.
    OIIO::ImageBuf normals(const TexelSurface& surface) const;

    struct Directions
    {
        /// Of unit length, row by row.
        std::vector<Imath::V3f> texels;
        /// Texels whose direction lies behind the mesh's surface, which a texture without a blue channel cannot hold.
        int64_t behind = 0;
    };
    /// B/|B| of each texel, in object space. Where nothing is seen, and around the charts, it is as in the open texels
    /// nearby; (0, 0, 1) if there are none.
    Directions object_directions() const;
    /// The same relative to the tangent frames of the surface: x along +u, y along +v, z along the normal.
    Directions tangent_directions() const;

private:
    Directions filled(std::vector<float> texels, Coverage known) const;

    int m_width = 0, m_height = 0;
    /// V, B.x, B.y, B.z.
    std::vector<float> m_texels;
    /// Of three channels, or empty.
    std::vector<float> m_normals;
    /// 1 where a chart is, or empty.
    std::vector<float> m_charts;
    const TexelSurface* m_surface = nullptr;
};

/// V^(1 / gamma), in place.
void apply_ao_gamma(OIIO::ImageBuf& occlusion, double gamma);

/// (n + 1) / 2 as R, G, B; G of (1 - n) / 2 if green is down.
OIIO::ImageBuf normal_texture(const MapTexels::Directions& directions, int width, int height, bool green_is_up);

} // namespace vmlight
