// SPDX-License-Identifier: Apache-2.0
/// Ray directions: low-discrepancy points, scrambled per texel and mapped to the hemisphere. Everything is a pure
/// function of (sample, texel, seed), so results do not depend on order or threads.
#pragma once

#include <Imath/ImathVec.h>
#include <vmlight/math/ray_fan.h>

#include <cstdint>
#include <memory>
#include <string>

namespace vmlight {

/// A point in the unit square, as 32-bit fractions (x / 2^32).
struct Point32
{
    uint32_t u, v;
};

/// Radical inverses in bases 2 and 3: the paper's sequence.
Point32 halton_point(uint32_t index);
/// The first two dimensions of Sobol's sequence.
Point32 sobol_point(uint32_t index);
/// Owen's nested scrambling of a 32-bit fraction: a random permutation of each half, quarter, ... of the interval.
/// Source: S. Laine, T. Karras, "Stratified Sampling for Stochastic Transparency", EGSR 2011, section 3.1
/// (the same hash).
uint32_t owen_scramble(uint32_t fraction, uint32_t seed);

/// Two independent 32-bit numbers for a texel.
Point32 texel_hash(uint32_t x, uint32_t y, uint32_t seed);

/// An orthonormal frame around a unit normal, right-handed.
/// Source: T. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
struct TangentFrame
{
    Imath::V3f tangent, bitangent, normal;
    explicit TangentFrame(const Imath::V3f& n);
};

class PointPattern;

/// The directions of all texels: `count` points, in the order of PointPattern.
class SamplePattern
{
public:
    /// @param sampler  "halton", "sobol" or "fibonacci"
    /// @param uniform  distribute directions uniformly over the hemisphere, else by the cosine
    SamplePattern(const std::string& sampler, int count, bool uniform);
    ~SamplePattern();

    int count() const;

    /// What turns the points into those of a texel. By "fibonacci", neighbours have shifts that complement each other
    /// (Lattice::shift()); by others, independent ones.
    Point32 texel(int x, int y, uint32_t seed) const;

    /// Fill `fan` with a texel's directions: unit vectors around frame.normal. Lane bits are set for directions
    /// strictly above the surface, on the side of `geometric_normal`.
    void directions(RayFan& fan, const TangentFrame& frame, const Imath::V3f& geometric_normal, Point32 texel) const;

    /// Scalar reference implementation; the vector code agrees to 4e-7 per component.
    void directions_scalar(RayFan& fan, const TangentFrame& frame, const Imath::V3f& geometric_normal,
                           Point32 texel) const;

private:
    std::unique_ptr<const PointPattern> m_points;
    bool m_uniform;
};

/// Sums over the directions whose lane bit is set, unweighted and weighted by the dot product with `weight_axis` (the
/// shading normal gives a cosine weight). Sums blocks of 1024 rays in float, blocks in double.
struct DirectionSums
{
    Imath::V3d sum { 0 };
    Imath::V3d weighted_sum { 0 };
    double weight = 0;
    int64_t rays = 0;
};
DirectionSums sum_directions(const RayFan& fan, const Imath::V3f& weight_axis);
DirectionSums sum_directions_scalar(const RayFan& fan, const Imath::V3f& weight_axis);

} // namespace vmlight
