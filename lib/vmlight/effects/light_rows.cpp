// SPDX-License-Identifier: Apache-2.0
#include <vmlight/effects/rows.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>

namespace vmlight {

namespace {

// Whether the albedo that is given is read.
bool is_read(const LightFacts& light)
{
    return light.albedo_low <= light.albedo_high;
}

// Seconds on two cores, about; what all else takes of a lightmap is in the same unit. Measured on the gazebo.
constexpr double kRaySeconds = 0.2e-6, kPointSeconds = 4.1e-6;
// Of a million texels and a disc of light.
constexpr double kSunSeconds = 0.15, kWideSeconds = 0.8;

// What takes so long for a million texels.
double texel_work(const LightFacts& light, double million)
{
    return million * double(light.lit) * 1e-6;
}

double bounce_work(const LightFacts& light)
{
    return light.traced_rays > 0 ? light.traced_rays * kRaySeconds + light.traced_points * kPointSeconds
        : light.has_environment  ? 0.15
                                 : 0.5;
}

std::string bounce_text(const LightFacts& light)
{
    const std::string count = light.traced_points < 1e4 ? format("{:.0f}", light.traced_points)
                                                        : format("{:.0f} thousand", light.traced_points * 1e-3);
    const std::string points = light.traced_points > 0 ? " and about " + count + " points off the map" : "";
    return format("texels see surfaces that send back up to {:.3g} of their light; {} rays a texel{}, traced once for "
                  "all light",
                  light.albedo_high, light.bounce_rays, points);
}

} // namespace

std::string suns_count_text(int suns, int wide_discs)
{
    const std::string wide = count_text(wide_discs, "wide disc", "wide discs");
    const std::string narrow = count_text(suns, "sun", "suns");
    return wide_discs == 0 ? narrow : suns == 0 ? wide : narrow + " and " + wide;
}

void decide_color(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const LightFacts& light = facts.light;
    dst.push_back(decision(effect, light.converts_color,
                           light.converts_color ? light.color_note : "all inputs are in the space of the result",
                           0.02));
    if (!light.converts_color)
        dst.back().impossible = "all inputs are in the space of the result";
}

void decide_rotation(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const double degrees = facts.light.rotation_degrees;
    dst.push_back(decision(effect, degrees > 0,
                           degrees > 0 ? format("the light is turned by {:.4g} degrees", degrees)
                                       : std::string("no rotation, or one by 0 degrees"),
                           0.01));
}

void decide_albedo(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const LightFacts& light = facts.light;
    const bool is_one = light.albedo_low == 1 && light.albedo_high == 1;
    const bool called = light.has_albedo && !is_one;
    dst.push_back(decision(effect, called,
                           !light.has_albedo     ? std::string("none is given")
                               : !is_read(light) ? std::string("it is switched off")
                               : is_one          ? std::string("it is 1 everywhere")
                                        : format("values from {:.3g} to {:.3g}", light.albedo_low, light.albedo_high),
                           texel_work(light, 0.1)));
    if (!light.has_albedo)
        dst.back().impossible = "no --albedo is given";
}

void decide_visibility(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const LightFacts& light = facts.light;
    const std::string lit = count_text(light.lit, "texel", "texels");
    dst.push_back(decision(effect, light.shadowed > 0,
                           light.lit == 0           ? std::string("V is 0 everywhere")
                               : light.shadowed > 0 ? format("V is below 1 in {} of {}", light.shadowed, lit)
                                                    : format("V is 1 in all of {}: the light of the open sky", lit)));
}

bool calls_for_bounce(const LightFacts& light)
{
    return light.wants_bounce && light.has_albedo && is_read(light) && light.no_bounce.empty() && !light.is_black
        && light.albedo_high > 0 && light.shadowed + light.hidden > 0;
}

void decide_bounce(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const LightFacts& light = facts.light;
    const bool called = calls_for_bounce(light);
    dst.push_back(decision(effect, called,
                           !light.wants_bounce     ? std::string("not asked for: --bounce auto adds it")
                               : !light.has_albedo ? std::string("no albedo is given: surfaces send nothing back")
                               : !is_read(light) ? std::string("the albedo is switched off: surfaces send nothing back")
                               : !light.no_bounce.empty()           ? light.no_bounce
                               : light.is_black                     ? std::string("the light is black")
                               : light.shadowed + light.hidden == 0 ? std::string("no texel sees a surface")
                               : !called                            ? std::string("the albedo is 0 everywhere")
                                                                    : bounce_text(light),
                           bounce_work(light)));
    if (!light.wants_bounce || !light.has_albedo || !is_read(light) || !light.no_bounce.empty())
        dst.back().impossible = dst.back().reason;
}

void decide_suns(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const LightFacts& light = facts.light;
    const bool called = light.wants_suns && light.no_suns.empty() && light.suns + light.wide_discs > 0;
    dst.push_back(decision(
        effect, called,
        !light.wants_suns            ? std::string("not asked for: --suns auto adds them")
            : !light.no_suns.empty() ? light.no_suns
            : !called                ? std::string("the light has no small strong source")
                      : format("{} with {} of the light; {}", suns_count_text(light.suns, light.wide_discs),
                               percent_text(light.sun_share),
                               light.has_stored_suns ? "the map stores what texels see of them, and no ray is traced"
                                                     : "one ray or more for each texel that faces them, at each "
                                                       "rotation"),
        texel_work(light, light.has_stored_suns ? 0.02 : kSunSeconds * light.suns + kWideSeconds * light.wide_discs)));
    if (!light.wants_suns || !light.no_suns.empty())
        dst.back().impossible = dst.back().reason;
}

void decide_filter(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const LightFacts& light = facts.light;
    dst.push_back(decision(effect, light.has_environment && !light.is_one_color,
                           !light.has_environment ? "the light is filtered already"
                               : light.is_one_color && light.is_rest
                               ? "without its suns the environment is of one colour, which no filter changes"
                               : light.is_one_color ? "the environment is of one colour, which no filter changes"
                                                    : "an environment is given",
                           0.35));
    if (!light.has_environment)
        dst.back().impossible = "the light is filtered already";
}

void decide_levels(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const LightFacts& light = facts.light;
    dst.push_back(decision(effect, light.levels > 1 && !light.is_one_color,
                           light.is_one_color ? std::string("the light is of one colour in all directions")
                               : light.levels > 1
                               ? format("the model {} reads {} images of the light", light.model, light.levels)
                               : format("the model {} reads one image of the light", light.model),
                           texel_work(light, 0.2)));
}

} // namespace vmlight
