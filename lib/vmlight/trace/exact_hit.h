// SPDX-License-Identifier: Apache-2.0
/// Hits that Embree's filters are asked about, in double, within instances too.
#pragma once

#include <vmlight/trace/embree_scene.h>

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>

namespace vmlight::embree {

/// Where a scene's instances are, by the numbers of their geometries.
class Placements
{
public:
    struct Placement
    {
        InstanceTransform transform;
        uint64_t bits; ///< that are those of no other place of the same mesh: for chance
        uint32_t mesh; ///< PlacedMeshes::mesh
    };

    void add(unsigned id, const Placement& placement)
    {
        if (m_all.empty())
            m_first = id;
        m_all.push_back(placement);
    }
    bool empty() const { return m_all.empty(); }
    const Placement& of(unsigned id) const { return m_all[id - m_first]; }

private:
    unsigned m_first = 0; // numbers follow each other
    std::vector<Placement> m_all;
};

/// A triangle and the ray that meets it, in the scene: of the floats that are traced. Of a piece of a cut-out one, the
/// triangle that the ray meets.
struct ExactHit
{
    /// @param lane     of the filter's hits
    ExactHit(const Buffers& buffers, const RTCFilterFunctionNArguments& arguments, unsigned lane);

    unsigned triangle; ///< of the buffers
    bool is_beyond = false; ///< the ray meets the piece, and no triangle
    std::array<Imath::V3d, 3> corners;
    Imath::V3f origin, direction;
    uint64_t bits; ///< of the place of its mesh

    /// The weights of the second and third corners, where the ray meets the triangle's plane.
    Imath::V2d weights() const;

private:
    void find_triangle(const Buffers& buffers, const Placements::Placement* placement, unsigned number);
};

/// The instance of a lane's hit, or nullptr.
const Placements::Placement* placement_of(const RTCFilterFunctionNArguments& arguments, unsigned lane);

} // namespace vmlight::embree
