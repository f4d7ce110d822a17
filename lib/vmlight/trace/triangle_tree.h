// SPDX-License-Identifier: Apache-2.0
/// Boxes around the triangles of a scene, in a tree, to ask whether anything rises above a plane.
#pragma once

#include <vmlight/trace/horizon.h>
#include <vmlight/trace/occluder.h>

#include <cstdint>
#include <vector>

namespace vmlight {

class TriangleTree
{
public:
    /// @param meshes   must outlive this
    explicit TriangleTree(const std::vector<TracedTriangles>& meshes);

    static constexpr uint32_t kNone = ~0u;

    /// A triangle within `reach` of `box`, in scene units, that has a corner which the horizon does not hide, or kNone.
    uint32_t find_above(const Horizon& horizon, const SceneBox& box, double reach) const;

    /// Whether this one, which find_above() found for another horizon, is such a triangle.
    bool is_above(uint32_t triangle, const Horizon& horizon, const SceneBox& box, double reach) const;

    /// Boxes and triangles that a horizon was compared with so far, by one thread at a time.
    int64_t tests() const { return m_tests; }

private:
    struct Node
    {
        SceneBox box;
        // Of the second child, the first being next; 0 in a leaf, which has these triangles.
        uint32_t second = 0, first_triangle = 0, triangles = 0;
    };
    struct Triangle
    {
        uint32_t mesh, index;
    };
    uint32_t build(std::vector<Imath::V3f>& middles, std::vector<uint32_t>& order, size_t begin, size_t end);
    const Imath::V3f& corner(const Triangle& triangle, int k) const
    {
        return m_meshes[triangle.mesh].corner(triangle.index, k);
    }

    const std::vector<TracedTriangles>& m_meshes;
    std::vector<Triangle> m_triangles;
    std::vector<Node> m_nodes;
    mutable int64_t m_tests = 0;
};

} // namespace vmlight
