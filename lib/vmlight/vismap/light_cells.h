// SPDX-License-Identifier: Apache-2.0
/// Cells: surfaces that light a map's texels and have no texels themselves. Occluders, the ground, the backs of the
/// mesh, and triangles that are on another tile or cover no texel.
#pragma once

#include <vmlight/trace/surface.h>

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace vmlight {

/// Where on a surface a point is whose light goes to texels.
struct LightPoint
{
    static constexpr int kGround = -2;
    /// BakeScene::kWhole, the index of an occluder, or kGround.
    int caster = kGround;
    /// Of the caster; of BakeScene::mesh() for kWhole, or kOtherPart where that is a part without the triangle.
    uint32_t triangle = 0;
    static constexpr uint32_t kOtherPart = ~0u;
    float u = 0, v = 0; ///< weights of the triangle's second and third corners
};

/// Cells of a grid whose points face alike. The farther from the texels that they light, the larger the cells.
class LightCells
{
public:
    /// Points that stand for a cell: the first that are added.
    static constexpr int kMostPoints = 4;

    struct Point
    {
        LightPoint where;
        Imath::V3f position, normal; ///< in scene space; on the side that rays meet
    };
    struct Cell
    {
        uint64_t key;
        int count = 0;
        std::array<Point, kMostPoints> points;
    };

    /// Add a point at `position`, which is `distance` away from the texel, both in scene units; `normal`, of unit
    /// length, is on the side that the texel sees. Returns the number of its cell.
    uint32_t add(const LightPoint& where, const Imath::V3f& position, const Imath::V3f& normal, float distance);

    /// Add the cells of `other`, and set `numbers` to what they are here.
    void merge(const LightCells& other, std::vector<uint32_t>& numbers);
    /// The numbers of the cells of `other`, all of which are here.
    void find(const LightCells& other, std::vector<uint32_t>& numbers) const;

    /// Hand over the points of all cells, in the order of their numbers: where they are, their surfaces, whose ray
    /// origins are not adjusted yet, and in `first` the number of each cell's first point, then the end. Only find()
    /// may follow.
    void take_points(std::vector<LightPoint>& points, std::vector<SurfacePoint>& surfaces,
                     std::vector<uint32_t>& first);

    size_t count() const { return m_numbers.size(); }
    /// Of all cells: what take_points() would hand over.
    size_t point_count() const;
    void clear();
    /// Approximate memory use.
    size_t bytes() const;

private:
    Cell& cell(uint64_t key);

    std::unordered_map<uint64_t, uint32_t> m_numbers;
    std::vector<Cell> m_cells;
};

} // namespace vmlight
