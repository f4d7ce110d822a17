// SPDX-License-Identifier: Apache-2.0
/// Cells: what a map has no texels of, and lights it all the same. Occluders, the ground, the backs of surfaces, and
/// triangles that are on another tile or cover no texel.
#pragma once

#include <vmlight/trace/surface.h>

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace vmlight {

/// A point of a surface whose light goes to texels.
struct LightPoint
{
    static constexpr int kGround = -2;
    /// BakeScene::kWhole, the index of an occluder, or kGround.
    int caster = kGround;
    uint32_t triangle = 0; ///< of it
    float u = 0, v = 0; ///< weights of the triangle's second and third corners
    /// Of the side that rays meet; its ray origin is not adjusted yet.
    SurfacePoint surface;
};

/// A flat surface at a position that a ray met, both in scene space. Its ray origins are farther off it where floats
/// round more.
SurfacePoint surface_point(const Imath::V3f& position, const Imath::V3f& normal);

/// Cells of a grid whose points face alike. The farther from the texels that they light, the larger the cells.
class LightCells
{
public:
    /// Points that stand for a cell: the first that are added.
    static constexpr int kMostPoints = 4;

    struct Cell
    {
        uint64_t key;
        int count = 0;
        std::array<LightPoint, kMostPoints> points;
    };

    /// Add a point at `position`, which is `distance` away from the texel, both in scene units; `normal`, of unit
    /// length, is on the side that the texel sees. Returns the number of its cell.
    uint32_t add(LightPoint point, const Imath::V3f& position, const Imath::V3f& normal, float distance);

    /// Add the cells of `other`, and set `numbers` to what they are here.
    void merge(const LightCells& other, std::vector<uint32_t>& numbers);
    /// The numbers of the cells of `other`, all of which are here.
    void find(const LightCells& other, std::vector<uint32_t>& numbers) const;

    const std::vector<Cell>& cells() const { return m_cells; }
    void clear();
    size_t bytes() const;

private:
    Cell& cell(uint64_t key);

    std::unordered_map<uint64_t, uint32_t> m_numbers;
    std::vector<Cell> m_cells;
};

} // namespace vmlight
