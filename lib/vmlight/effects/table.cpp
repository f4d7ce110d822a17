// SPDX-License-Identifier: Apache-2.0
#include <vmlight/effects/rows.h>

#include <vmlight/base/format.h>

namespace vmlight {
namespace {

// Name, phrase, stage; can be off, can be forced, changes texels; decide.
constexpr Effect kEffects[] = {
    { "self-occlusion", "the mesh blocks its own rays", "vismap", true, true, true, decide_self_occlusion },
    { "occluders", "other meshes block rays", "vismap", true, true, true, decide_occluders },
    { "ground", "a horizontal plane blocks rays", "vismap", true, false, true, decide_ground },
    { "cut-outs", "light passes where materials are transparent", "vismap", true, true, true, decide_cutouts },
    { "normal-map", "texels have normals of their own", "vismap", true, false, true, decide_normal_map },
    { "max-distance", "what is far away blocks no ray", "vismap", true, false, true, decide_distance },
    { "poses", "the mesh deforms", "vismap", false, false, true, decide_poses },
    { "udim", "a tile of UV space other than the first", "vismap", false, false, true, decide_udim },
    { "reconstruction", "texels are averaged with neighbours that see the same", "vismap", true, false, false,
      decide_reconstruction },
    { "margin", "texels around UV islands are filled", "vismap", true, false, false, decide_margin },
    { "half", "16 bits per channel", "vismap", false, false, true, decide_half },
    { "color-conversion", "inputs are brought to one colour space", "lightmap", false, false, true, decide_color },
    { "visibility", "part of the sky is hidden", "lightmap", false, false, true, decide_visibility },
    { "suns", "small strong lights throw shadows with edges", "lightmap", true, false, true, decide_suns },
    { "filter", "the environment is filtered by the cosine", "lightmap", false, true, true, decide_filter },
    { "stack-levels", "the light is read at several widths of the filter", "lightmap", false, true, true,
      decide_levels },
    { "rotation", "the light is turned", "lightmap", true, false, true, decide_rotation },
    { "albedo", "light is multiplied by a texture", "lightmap", true, true, true, decide_albedo },
    { "bounce", "surfaces light each other, once", "lightmap", true, false, true, decide_bounce },
};

} // namespace

std::string percent_text(double share)
{
    const double percent = 100 * share;
    return percent == 0 ? "0 %" : percent < 1 ? "< 1 %" : format("{:.0f} %", percent);
}

EffectDecision decision(const Effect& effect, bool called_for, std::string reason, double work)
{
    return { effect.name, "", called_for, called_for, std::move(reason), work, "" };
}

OIIO::cspan<Effect> all_effects()
{
    return kEffects;
}

} // namespace vmlight
