// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/open_triangles.h>

#include <vmlight/base/stopwatch.h>
#include <vmlight/trace/facet.h>
#include <vmlight/trace/triangle_tree.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vmlight {

using Imath::V3d;
using Imath::V3f;

namespace {

// What a triangle of the scene costs to be sorted into the tree, or one of the mesh to be asked about, in rays: nothing
// is searched that may not pay. Measured on one thread: 1.5 us where something rises above most, 12 us on a ball of
// 16000 triangles, where the tree has to be searched for all; .08 us a ray on two.
constexpr double kRaysPerTriangle = 150;
// So few are searched for next to nothing.
constexpr double kFewTriangles = 1000;
// Looked at before anything else: a mesh whose triangles all have something above them costs no more than this.
constexpr size_t kTriangles = 64, kVertices = 256;
constexpr size_t kKnown = 8;

double uv_area(const Mesh& mesh, const std::array<uint32_t, 3>& triangle)
{
    for (const uint32_t corner : triangle)
        if (!has_uv(mesh, corner))
            return 0;
    const auto &a = mesh.uvs[triangle[0]], &b = mesh.uvs[triangle[1]], &c = mesh.uvs[triangle[2]];
    return std::abs(double(b.x - a.x) * double(c.y - a.y) - double(c.x - a.x) * double(b.y - a.y)) / 2;
}

// Of triangles evenly over the mesh, the share above which no vertex rises, of vertices evenly over the scene: about
// what a search would prove, and mostly more.
double promise(const BakeScene& scene, const std::vector<TracedTriangles>& traced, size_t all, double reach,
               int64_t& tests)
{
    std::vector<V3f> vertices;
    const size_t vertex_step = std::max<size_t>(1, all / kVertices);
    size_t at = 0;
    for (const TracedTriangles& mesh : traced) {
        for (; at < mesh.count; at += vertex_step)
            vertices.push_back(mesh.corner(at, int(at / vertex_step % 3)));
        at -= mesh.count;
    }
    const size_t count = scene.mesh().triangles.size(), step = std::max<size_t>(1, count / kTriangles);
    double tested = 0, hiding = 0;
    for (size_t t = step / 2; t < count; t += step) {
        const Facet facet(scene, uint32_t(t));
        if (!facet.has_area())
            continue;
        const Horizon horizon = facet.horizon();
        const auto rises = [&](const V3f& p) {
            ++tests;
            SceneBox point;
            point.add(p);
            return !horizon.hides(V3d(p)) && point.distance2(facet.box) <= reach * reach;
        };
        ++tested;
        hiding += std::none_of(vertices.begin(), vertices.end(), rises);
    }
    return tested > 0 ? hiding / tested : 0;
}

// Whether something rises above the horizon. What did above one triangle mostly does above the next: `known` has the
// latest of them, first.
bool is_covered(const TriangleTree& tree, std::array<uint32_t, kKnown>& known, const Horizon& horizon,
                const SceneBox& box, double reach)
{
    size_t at = 0;
    while (at < kKnown && known[at] != TriangleTree::kNone && !tree.is_above(known[at], horizon, box, reach))
        ++at;
    const bool is_new = at == kKnown || known[at] == TriangleTree::kNone;
    const uint32_t found = is_new ? tree.find_above(horizon, box, reach) : known[at];
    if (found == TriangleTree::kNone)
        return false;
    const auto last = known.begin() + long(std::min(at, kKnown - 1));
    *last = found;
    std::rotate(known.begin(), last, last + 1);
    return true;
}

} // namespace

void OpenTriangles::find(const BakeScene& scene, double reach, double rays)
{
    const Stopwatch timer;
    const Mesh& mesh = scene.mesh();
    if (scene.occluder().instances().instances > 0) { // whose triangles are not there to be searched
        m_open.clear();
        m_report = {};
        return;
    }
    const std::vector<TracedTriangles> traced = scene.occluder().triangles();
    size_t all = 0;
    for (const TracedTriangles& part : traced)
        all += part.count;
    m_open.clear();
    m_report = {};
    if (scene.occluder().has_strands()) // which the tree does not hold
        return;
    const double share = promise(scene, traced, all, reach, m_report.tests);
    const double triangles = double(all + mesh.triangles.size());
    m_report.searched = share > 0 && (triangles <= kFewTriangles || share * rays >= kRaysPerTriangle * triangles);
    if (m_report.searched) {
        const TriangleTree tree(traced);
        m_open.assign(mesh.triangles.size(), 0);
        std::array<uint32_t, kKnown> known;
        known.fill(TriangleTree::kNone);
        double area = 0, open_area = 0;
        for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            const double own = uv_area(mesh, mesh.triangles[t]);
            if (own == 0)
                continue;
            const Facet facet(scene, t);
            if (!facet.has_area()) // no texel
                continue;
            area += own;
            ++m_report.triangles;
            if (is_covered(tree, known, facet.horizon(), facet.box, reach))
                continue;
            m_open[t] = 1;
            ++m_report.open;
            open_area += own;
        }
        m_report.open_share = area > 0 ? open_area / area : 0;
        m_report.tests += tree.tests();
        if (m_report.open == 0)
            m_open.clear();
    }
    m_report.seconds = timer();
}

} // namespace vmlight
