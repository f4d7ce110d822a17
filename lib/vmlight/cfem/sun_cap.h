// SPDX-License-Identifier: Apache-2.0
/// The light of a small lat-long map around one direction, where a sun may be.
#pragma once

#include <vmlight/cfem/suns.h>

#include <OpenImageIO/imagebuf.h>

#include <vector>

namespace vmlight {

/// A map as the search for suns reads it.
struct SunMap
{
    explicit SunMap(const OIIO::ImageBuf& map);

    double height_of_texel() const { return latlong::pi / height; }

    int width, height;
    std::vector<float> rgb, light; ///< light: the mean of R, G and B
    std::vector<double> area; ///< of a texel of each row
    std::vector<Imath::V3d> direction;
    double least_radius; ///< of a cut: two texels of a map 512 wide, or as many as hold a point's light
    double all = 0; ///< light over the sphere

    static constexpr double kMostRadius = 12 * latlong::pi / 180; ///< of a cut
};

/// A cap that may become a cut.
struct SunCandidate
{
    SunSplit::Cut cut;
    double gain = 0; ///< energy, less for wide discs
    Imath::V3d direction { 0 }; ///< of the first moment
};

/// Texels around `centre`, sorted by their distance: all within a cut and the ring around it.
class SunCap
{
public:
    /// A texel: its angle from the centre, in radians.
    struct Texel
    {
        float angle, light, area;
        uint32_t index;
    };

    SunCap(const SunMap& map, const Imath::V3d& centre);

    const std::vector<Texel>& texels() const { return m_texels; }

    /// The cap that gains most, of some radii.
    ///
    /// @param between_steps    look between them as well, so that the radius does not jump where the map changes a
    ///                         little
    SunCandidate grow(bool between_steps) const;
    /// The median of a channel in the ring around a cap of `radius`.
    double background(double radius, size_t channel) const;

private:
    struct Knot
    {
        double radius, background;
    };
    SunCandidate cap(double radius, double background) const;
    double end_of_light() const;
    template <class Value> double ring_median(double radius, Value&& value) const;
    std::vector<Texel>::const_iterator beyond(double angle) const;

    const SunMap& m_map;
    const Imath::V3d m_centre;
    std::vector<Texel> m_texels;
    mutable std::vector<std::pair<float, float>> m_ring; // value, weight
};

} // namespace vmlight
