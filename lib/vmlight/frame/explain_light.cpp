// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/explain_light.h>

#include <vmlight/base/format.h>
#include <vmlight/effects/effect.h>
#include <vmlight/stage/light_facts.h>
#include <vmlight/stage/sun_choice.h>

#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

namespace vmlight {
namespace {

// Of a lightmap's: colour, filters and albedos are not chosen here.
constexpr std::array<const char*, 4> kRows { "rotation", "visibility", "suns", "bounce" };

} // namespace

bool explain_traced(const std::string& name, const TraceParams& trace, const OIIO::ImageBuf& map,
                    const SceneLight& light, const LightmapParams& params, const OIIO::ImageBuf* albedo,
                    BounceShading* bounce, const MakeOptions& options, std::string& error)
{
    Rotation rotation;
    if (!lightmap_rotation(rotation, params, error))
        return false;
    EffectFacts facts;
    LightFacts& dst = facts.light;
    dst.rotation_degrees = rotation_degrees(rotation);
    find_visibility_facts(dst, map);
    dst.wants_suns = trace.suns != "off";
    dst.suns = int(light.suns.size());
    dst.sun_share = sun_share(light.suns, light.filtered[0], true);
    dst.is_black = is_black(light.filtered, &light.suns);
    dst.wants_bounce = trace.bounce.bounce != "off";
    dst.bounce_rays = trace.bounce.bounce_rays;
    dst.has_albedo = albedo != nullptr;
    if (albedo) {
        const auto range = OIIO::ImageBufAlgo::computePixelStats(*albedo);
        dst.albedo_low = *std::min_element(range.min.begin(), range.min.end());
        dst.albedo_high = *std::max_element(range.max.begin(), range.max.end());
    }
    std::vector<EffectDecision> all, shown;
    if (!find_bounce_facts(dst, bounce, map, options, error)
        || !decide_effects(all, LightmapRecipe::kStage, facts, {}, error))
        return false;
    std::copy_if(all.begin(), all.end(), std::back_inserter(shown), [](const EffectDecision& decision) {
        return std::find(kRows.begin(), kRows.end(), decision.name) != kRows.end();
    });
    options.report_answer(format("effects: {}:", name));
    for (const std::string& line : decision_lines(shown))
        options.report_answer(line);
    return true;
}

} // namespace vmlight
