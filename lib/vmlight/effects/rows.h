// SPDX-License-Identifier: Apache-2.0
/// How each effect of the table is decided, and what their sentences share.
#pragma once

#include <vmlight/effects/effect.h>

#include <string>
#include <vector>

namespace vmlight {

/// "12 %"; "< 1 %" of more than nothing.
std::string percent_text(double share);
/// Whether the bounce can change the picture.
bool calls_for_bounce(const LightFacts& light);
/// A decision on the one of its kind. `work` is what it takes where it is on, relative to a stage:
/// EffectDecision::share.
EffectDecision decision(const Effect& effect, bool called_for, std::string reason, double work = 0);

// Effect::decide of a bake.
void decide_self_occlusion(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts);
void decide_occluders(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts);
void decide_ground(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts);
void decide_cutouts(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts);
void decide_normal_map(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts);
void decide_distance(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts);
void decide_poses(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts);
void decide_udim(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts);
void decide_reconstruction(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts);
void decide_margin(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts);
void decide_half(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts);

// Effect::decide of a lightmap.
void decide_color(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts);
void decide_rotation(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts);
void decide_albedo(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts);
void decide_visibility(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts);
void decide_bounce(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts);
void decide_suns(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts);
void decide_filter(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts);
void decide_levels(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts);

} // namespace vmlight
