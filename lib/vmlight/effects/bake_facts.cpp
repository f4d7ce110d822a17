// SPDX-License-Identifier: Apache-2.0
#include <vmlight/effects/bake_facts.h>

#include <vmlight/trace/surface.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vmlight {
namespace {

// What of its hemisphere a surface that leans by this much more sees of the ground is V of 1e-12.
constexpr double kStraight = 1e-6;

template <class Normal> bool is_straight(const Normal& n)
{
    return double(n.y) > 0 && std::abs(double(n.x)) < kStraight && std::abs(double(n.z)) < kStraight;
}

// Whether all triangles that have texels face straight up, and so do the normals that they are shaded with.
bool all_face_up(const Mesh& mesh)
{
    return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const std::array<uint32_t, 3>& triangle) {
        const Imath::V3d normal = surface_normal(mesh, triangle);
        return !(normal.length2() > 0.5)
            || (is_straight(normal) && std::all_of(triangle.begin(), triangle.end(), [&](uint32_t vertex) {
                    return is_straight(mesh.normals[vertex]);
                }));
    });
}

} // namespace

BakeFacts bake_facts(const BakeScene& scene, const VismapBaker& baker, int64_t covered)
{
    const VismapParams& params = baker.params();
    const OpenReport& open = baker.open().report();
    BakeFacts facts;
    const UvReport& uv = baker.uv_report();
    facts.triangles = open.searched ? open.triangles : uv.triangles - uv.without_uv;
    facts.open_triangles = open.open;
    facts.open_share = open.open_share;
    facts.proven = open.searched;
    facts.covered = covered;
    facts.texels = int64_t(baker.width()) * baker.height();
    facts.occluders.assign(scene.reach().begin() + ptrdiff_t(scene.choice().own_parts), scene.reach().end());
    facts.tests = open.tests;
    for (const CasterReach& caster : facts.occluders)
        facts.tests += caster.tests;
    facts.cutouts = scene.occluder().cutouts();
    facts.has_ground = params.ground;
    facts.lowest = scene.lowest();
    facts.ground_height = params.ground_height == VismapParams::kLowest ? scene.lowest() : params.ground_height;
    facts.faces_up = all_face_up(scene.mesh());
    facts.diagonal = scene.diagonal();
    facts.reach = facts.given_reach = params.max_distance;
    facts.margin = params.margin;
    facts.udim = params.udim;
    return facts;
}

} // namespace vmlight
