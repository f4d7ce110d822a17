// SPDX-License-Identifier: Apache-2.0
#include <vmlight/effects/bake_facts.h>

namespace vmlight {

BakeFacts bake_facts(const BakeScene& scene, const VismapBaker& baker, int64_t covered)
{
    const VismapParams& params = baker.params();
    const OpenReport& open = baker.open().report();
    BakeFacts facts;
    facts.triangles = int64_t(scene.mesh().triangles.size());
    facts.open_triangles = open.open;
    facts.open_share = open.open_share;
    facts.proven = open.searched;
    facts.self = scene.choice().self;
    facts.covered = covered;
    facts.texels = int64_t(baker.width()) * baker.height();
    facts.occluders = scene.reach();
    facts.tests = open.tests;
    for (const CasterReach& caster : facts.occluders)
        facts.tests += caster.tests;
    facts.cutouts = scene.occluder().cutouts();
    facts.has_ground = params.ground;
    facts.lowest = scene.lowest();
    facts.ground_height = params.ground_height == VismapParams::kLowest ? scene.lowest() : params.ground_height;
    facts.diagonal = scene.diagonal();
    facts.reach = params.max_distance;
    facts.margin = params.margin;
    facts.udim = params.udim;
    return facts;
}

} // namespace vmlight
