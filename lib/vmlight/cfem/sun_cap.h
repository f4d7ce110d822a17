// SPDX-License-Identifier: Apache-2.0
/// The light of a small lat-long map around one direction, where a sun may be.
#pragma once

#include <vmlight/cfem/suns.h>

#include <OpenImageIO/imagebuf.h>

#include <array>
#include <vector>

namespace vmlight {

/// What the search takes for one light. Angles are in radians.
struct SunScale
{
    double least_radius, most_radius; ///< of a cut
    double ring_width; ///< of the ring around a cut, whose median is the background
    double model_width; ///< half angle of a disc that models light as well as rays do
    double rise; ///< a cut ends where the light rises again by this factor: another source begins
    std::array<int, 3> seed_rows; ///< cells from pole to pole in which seeds are looked for
    double near, still; ///< seeds that come so near each other are one; so little does a found one move in the end
    bool is_wide;
};

/// A map as the search for suns reads it.
struct SunMap
{
    SunMap(const OIIO::ImageBuf& map, const SunScale& scale);
    /// The same map, `factor` times smaller, which must divide its size.
    SunMap reduced(int factor, const SunScale& scale) const;

    double height_of_texel() const { return latlong::pi / height; }

    int width, height;
    std::vector<float> rgb, light; ///< light: the mean of R, G and B
    std::vector<double> area; ///< of a texel of each row
    std::vector<Imath::V3d> direction;
    double all = 0; ///< light over the sphere
    SunScale scale; ///< its least radius holds a point's light

private:
    SunMap(int width, int height, std::vector<float> rgb, const SunScale& scale);
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
