// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/triangle_tree.h>

#include <algorithm>
#include <array>
#include <numeric>

namespace vmlight {

using Imath::V3d;
using Imath::V3f;

namespace {

constexpr size_t kLeaf = 8;
// Ray origins are off the surface, and lengths are floats.
constexpr double kSlack = 1e-5, kOffsets = 4 * kRayOffset;

} // namespace

TriangleTree::TriangleTree(const std::vector<TracedTriangles>& meshes)
    : m_meshes(meshes)
{
    size_t count = 0;
    for (const TracedTriangles& mesh : meshes)
        count += mesh.count;
    if (count == 0)
        return;
    m_triangles.reserve(count);
    for (uint32_t mesh = 0; mesh < meshes.size(); ++mesh)
        for (uint32_t i = 0; i < meshes[mesh].count; ++i)
            m_triangles.push_back({ mesh, i });
    std::vector<V3f> middles;
    middles.reserve(count);
    for (const Triangle& triangle : m_triangles)
        middles.push_back(corner(triangle, 0) + corner(triangle, 1) + corner(triangle, 2));
    std::vector<uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    m_nodes.reserve(4 * count / kLeaf + 1);
    build(middles, order, 0, count);
    std::vector<V3f>().swap(middles); // before the triangles are there twice
    std::vector<Triangle> sorted;
    sorted.reserve(count);
    for (const uint32_t i : order)
        sorted.push_back(m_triangles[i]);
    m_triangles = std::move(sorted);
}

// Halves of equal number: at most 32 levels deep.
uint32_t TriangleTree::build(std::vector<V3f>& middles, std::vector<uint32_t>& order, size_t begin, size_t end)
{
    const auto index = uint32_t(m_nodes.size());
    m_nodes.emplace_back();
    SceneBox box, spread;
    for (size_t i = begin; i < end; ++i) {
        spread.add(middles[order[i]]);
        for (int k = 0; k < 3; ++k)
            box.add(corner(m_triangles[order[i]], k));
    }
    m_nodes[index].box = box;
    if (end - begin <= kLeaf) {
        m_nodes[index].first_triangle = uint32_t(begin);
        m_nodes[index].triangles = uint32_t(end - begin);
        return index;
    }
    const V3f size = spread.high - spread.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const size_t middle = begin + (end - begin) / 2;
    std::nth_element(order.begin() + long(begin), order.begin() + long(middle), order.begin() + long(end),
                     [&](uint32_t a, uint32_t b) { return middles[a][axis] < middles[b][axis]; });
    build(middles, order, begin, middle);
    m_nodes[index].second = build(middles, order, middle, end);
    return index;
}

bool TriangleTree::is_above(uint32_t triangle, const Horizon& horizon, const SceneBox& box, double reach) const
{
    ++m_tests;
    SceneBox own;
    bool hidden = true;
    for (int k = 0; k < 3; ++k) {
        const V3f& p = corner(m_triangles[triangle], k);
        own.add(p);
        hidden = hidden && horizon.hides(V3d(p));
    }
    const double far = reach * (1 + kSlack) + kOffsets;
    return !hidden && own.distance2(box) <= far * far;
}

uint32_t TriangleTree::find_above(const Horizon& horizon, const SceneBox& box, double reach) const
{
    if (m_nodes.empty())
        return kNone;
    const double far = reach * (1 + kSlack) + kOffsets, far2 = far * far;
    std::array<uint32_t, 64> stack;
    size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const uint32_t index = stack[--depth];
        const Node& node = m_nodes[index];
        ++m_tests;
        if (horizon.hides(node.box) || node.box.distance2(box) > far2)
            continue;
        if (node.triangles == 0) {
            stack[depth++] = node.second;
            stack[depth++] = index + 1;
            continue;
        }
        for (uint32_t i = node.first_triangle; i < node.first_triangle + node.triangles; ++i)
            if (is_above(i, horizon, box, reach))
                return i;
    }
    return kNone;
}

} // namespace vmlight
