// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/pose_proof.h>

#include <vmlight/base/parallel.h>
#include <vmlight/trace/facet.h>
#include <vmlight/trace/triangle_tree.h>
#include <vmlight/vismap/pose_ground.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vmlight {

using Imath::V3d;
using Imath::V3f;

namespace {

constexpr int64_t kStep = 256; // triangles that one thread takes at once

bool keeps_normals(const Mesh& before, const Mesh& after, uint32_t triangle, const Rotation& turn)
{
    for (size_t k = 0; k < 3; ++k) {
        const V3f a = before.normals[before.triangles[triangle][k]], b = after.normals[after.triangles[triangle][k]];
        if (!((rotate(turn, V3d(a)) - V3d(b)).length() <= kSameNormal))
            return false;
    }
    return true;
}

// Exactly: rays are made of it.
bool is_same_surface(const Mesh& before, const Mesh& after, uint32_t triangle)
{
    for (size_t k = 0; k < 3; ++k) {
        const uint32_t from = before.triangles[triangle][k], to = after.triangles[triangle][k];
        if (before.normals[from] != after.normals[to] || before.positions[from] != after.positions[to])
            return false;
    }
    return true;
}

// What rays can meet and does not move with a body, in one pose.
class Others
{
public:
    Others(TracedTriangles PosedPart::*pose, const PoseMotion& motion, uint32_t body)
    {
        size_t at = 0;
        for (const PosedPart& part : motion.parts()) {
            m_indices.emplace_back();
            for (size_t i = 0; i < part.count(); ++i, ++at)
                if ((part.*pose).count > 0 && motion.body_of_traced(at) != body)
                    m_indices.back().push_back((part.*pose).triangles[i]);
        }
        for (size_t i = 0; i < m_indices.size(); ++i)
            m_others.push_back({ (motion.parts()[i].*pose).vertices, m_indices[i].data(), m_indices[i].size() });
        m_tree = std::make_unique<TriangleTree>(m_others);
    }
    bool rise_above(const Facet& facet, double reach) const
    {
        return !facet.has_area() || m_tree->find_above(facet.horizon(), facet.box, reach) != TriangleTree::kNone;
    }

private:
    std::vector<TracedTriangles> m_others;
    std::vector<std::vector<std::array<uint32_t, 3>>> m_indices;
    std::unique_ptr<TriangleTree> m_tree;
};

} // namespace

std::vector<uint8_t> prove_same_view(const PoseMotion& motion, const VismapParams& params, bool search, int nthreads)
{
    const BakeScene &base = motion.base(), &pose = motion.pose();
    const Mesh &before = base.mesh(), &after = pose.mesh();
    const auto triangles = uint32_t(before.triangles.size());
    std::vector<uint8_t> same(triangles, 0);
    for (uint32_t body = 0; body < motion.motions().size(); ++body) {
        const RigidMotion& own = motion.motions()[body];
        if (!search && !motion.is_whole())
            continue;
        std::unique_ptr<Others> others_before, others_after;
        if (!motion.is_whole()) {
            others_before = std::make_unique<Others>(&PosedPart::base, motion, body);
            others_after = std::make_unique<Others>(&PosedPart::pose, motion, body);
        }
        const double reach_before = params.max_distance * base.frame().scale;
        const double reach_after = params.max_distance * pose.frame().scale;
        const bool is_still = body == 0 && motion.stands_still();
        const auto prove = [&](int64_t item, int) {
            const auto end = uint32_t(std::min<int64_t>(triangles, (item + 1) * kStep));
            for (auto t = uint32_t(item * kStep); t < end; ++t)
                same[t] = same[t]
                    || (motion.body(t) == body
                        && (is_still ? is_same_surface(before, after, t) : keeps_normals(before, after, t, own.turn))
                        && (!others_before
                            || (!others_before->rise_above(Facet(base, t), reach_before)
                                && !others_after->rise_above(Facet(pose, t), reach_after))));
        };
        parallel_items((triangles + kStep - 1) / kStep, nthreads, prove);
    }
    return same;
}

std::vector<uint8_t> find_still(const PoseMotion& motion, const VismapParams& params)
{
    const Mesh &before = motion.base().mesh(), &after = motion.pose().mesh();
    std::vector<uint8_t> still(before.triangles.size(), 0);
    if (!motion.stands_still() || !is_same_ground(motion.base(), motion.pose(), params))
        return still;
    for (uint32_t t = 0; t < still.size(); ++t)
        still[t] = motion.body(t) == 0 && is_same_surface(before, after, t);
    return still;
}

bool have_same_normals(const NormalMapPointer& base, const NormalMapPointer& pose)
{
    return base && pose ? base->is_same_image(*pose) : base == pose;
}

} // namespace vmlight
