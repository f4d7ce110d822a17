// SPDX-License-Identifier: Apache-2.0
/// The points of a sampler in the order in which they become the lanes of packets: Embree is fastest where the eight
/// rays of a packet go nearly the same way. Not installed.
#pragma once

#include <vmlight/math/lattice.h>
#include <vmlight/math/sampling.h>
#include <vmlight/math/sampling_kernel.h>

#include <Imath/ImathVec.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace vmlight {

class PointPattern
{
public:
    /// Which way a point of the unit square goes, at unit length. v turns it around an axis.
    using Direction = std::function<Imath::V3d(const Point32&)>;

    /// @param sampler  "halton", "sobol" or "fibonacci"
    PointPattern(const std::string& sampler, int count, const Direction& direction);

    int count() const { return m_count; }
    /// Of "fibonacci", nullptr of others.
    const Lattice* lattice() const { return m_lattice ? &*m_lattice : nullptr; }

    /// The points as a texel shifts or scrambles them, in whole packets. Packets of a lattice keep their shape in all
    /// texels, those of Sobol' points that of their intervals; those of Halton points are torn where shifts wrap.
    kernel::Points points(Point32 texel, bool uniform) const;

private:
    int m_count;
    bool m_owen;
    std::optional<Lattice> m_lattice;
    // Padded to whole packets. Texels shift them modulo 1 (Cranley-Patterson) or Owen-scramble them (stored
    // bit-reversed).
    std::vector<uint32_t> m_u, m_v;
};

} // namespace vmlight
