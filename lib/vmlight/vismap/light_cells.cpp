// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/light_cells.h>

#include <algorithm>
#include <cmath>

namespace vmlight {
namespace {

using Imath::V3f;

// Cells are 1/16 to 1/32 as long as the way of their light, and at least 1/64 in scene units: 1/64 to 1/128 of the
// mesh.
constexpr int kFinest = -6, kPerOctave = 4;

uint64_t key_of(int caster, const V3f& position, const V3f& normal, float distance)
{
    const int octave = std::clamp(std::ilogb(std::max(distance, 1e-6f)) - kPerOctave, kFinest, 120);
    uint64_t key = uint64_t(octave - kFinest);
    for (int axis = 0; axis < 3; ++axis) {
        const float cell = std::floor(std::ldexp(position[axis], -octave));
        key = key << 12 | uint64_t(int64_t(std::clamp(cell, -2048.0f, 2047.0f)) + 2048);
    }
    const V3f size(std::abs(normal.x), std::abs(normal.y), std::abs(normal.z));
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    return (key << 3 | uint64_t(2 * axis + (normal[axis] < 0))) << 16 | uint64_t(uint16_t(caster + 2));
}

} // namespace

LightCells::Cell& LightCells::cell(uint64_t key)
{
    const auto [found, is_new] = m_numbers.emplace(key, uint32_t(m_cells.size()));
    if (is_new) {
        m_cells.emplace_back();
        m_cells.back().key = key;
    }
    return m_cells[found->second];
}

uint32_t LightCells::add(const LightPoint& where, const V3f& position, const V3f& normal, float distance)
{
    Cell& own = cell(key_of(where.caster, position, normal, distance));
    if (own.count < kMostPoints)
        own.points[size_t(own.count++)] = { where, position, normal };
    return uint32_t(&own - m_cells.data());
}

void LightCells::merge(const LightCells& other, std::vector<uint32_t>& numbers)
{
    numbers.clear();
    for (const Cell& added : other.m_cells) {
        Cell& own = cell(added.key);
        for (int i = 0; i < added.count && own.count < kMostPoints; ++i)
            own.points[size_t(own.count++)] = added.points[size_t(i)];
        numbers.push_back(uint32_t(&own - m_cells.data()));
    }
}

void LightCells::find(const LightCells& other, std::vector<uint32_t>& numbers) const
{
    numbers.clear();
    for (const Cell& cell : other.m_cells)
        numbers.push_back(m_numbers.at(cell.key));
}

size_t LightCells::point_count() const
{
    size_t count = 0;
    for (const Cell& cell : m_cells)
        count += size_t(cell.count);
    return count;
}

void LightCells::take_points(std::vector<LightPoint>& points, std::vector<SurfacePoint>& surfaces,
                             std::vector<uint32_t>& first)
{
    const size_t count = point_count();
    points.clear();
    points.reserve(count);
    surfaces.clear();
    surfaces.reserve(count);
    first.clear();
    first.reserve(m_cells.size() + 1);
    for (const Cell& cell : m_cells) {
        first.push_back(uint32_t(points.size()));
        for (int i = 0; i < cell.count; ++i) {
            const Point& point = cell.points[size_t(i)];
            points.push_back(point.where);
            surfaces.push_back(flat_surface(point.position, point.normal));
        }
    }
    first.push_back(uint32_t(points.size()));
    m_cells = {};
}

void LightCells::clear()
{
    m_numbers.clear();
    m_cells.clear();
}

size_t LightCells::bytes() const
{
    constexpr size_t kNode = 4 * sizeof(void*); // of a hash table
    return m_cells.capacity() * sizeof(Cell) + m_numbers.size() * kNode;
}

} // namespace vmlight
