// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/light_cells.h>

#include <algorithm>
#include <cmath>

namespace vmlight {
namespace {

using Imath::V3f;

// Cells are 1/16 to 1/32 as long as the way of their light, and 1/128 of the mesh at least.
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

SurfacePoint surface_point(const V3f& position, const V3f& normal)
{
    // Floats round far away.
    const double reach
        = std::max({ 1.0, double(std::abs(position.x)), double(std::abs(position.y)), double(std::abs(position.z)) });
    SurfacePoint point;
    point.normal = point.mesh_normal = point.geometric_normal = normal;
    point.origin = position + normal * float(reach * kRayOffset);
    point.near_origin = position + normal * float(reach * kNearRayOffset);
    return point;
}

LightCells::Cell& LightCells::cell(uint64_t key)
{
    const auto [found, is_new] = m_numbers.emplace(key, uint32_t(m_cells.size()));
    if (is_new) {
        m_cells.emplace_back();
        m_cells.back().key = key;
    }
    return m_cells[found->second];
}

uint32_t LightCells::add(LightPoint point, const V3f& position, const V3f& normal, float distance)
{
    Cell& own = cell(key_of(point.caster, position, normal, distance));
    if (own.count < kMostPoints) {
        point.surface = surface_point(position, normal);
        own.points[size_t(own.count++)] = point;
    }
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

void LightCells::clear()
{
    m_numbers.clear();
    m_cells.clear();
}

size_t LightCells::bytes() const
{
    return m_cells.capacity() * sizeof(Cell) + m_numbers.size() * 4 * sizeof(void*);
}

} // namespace vmlight
