// SPDX-License-Identifier: Apache-2.0
/// Effects: what light can do in a scene, each simulated only where it can change the picture. An effect is one row of
/// the table in table.cpp; switches, the table that --explain prints, and the documentation ask the table.
#pragma once

#include <vmlight/effects/facts.h>
#include <vmlight/effects/switches.h>

#include <OpenImageIO/span.h>

#include <string>
#include <vector>

namespace vmlight {

/// What was decided on an effect, or on one of several of a kind, such as an occluder.
struct EffectDecision
{
    /// Of the effect; which of its kind, or "".
    std::string name, which;
    /// Whether it is simulated, and whether it can change the picture.
    bool on = false, called_for = false;
    /// A sentence with numbers, without a final period.
    std::string reason;
    /// Expected share of the work, in [0, 1]; those of all decisions add up to less than 1. Before decide_effects() has
    /// seen them all: what it takes, relative to the work of a stage on its own.
    double share = 0;
    /// Why it cannot be simulated, or "".
    std::string impossible;
};

struct Effect
{
    /// For switches and tables; what it is, in a phrase; the stage that simulates it.
    const char *name, *phrase, *stage;
    /// Whether it can be switched off: the picture is then another.
    bool can_be_off;
    /// Whether switching it on makes work where nothing calls for it. The others have nothing to do there, and stay
    /// off.
    bool can_be_forced;
    /// Whether texels that the mesh covers see something else, so that the difference says what leaving it out costs.
    bool changes_texels;
    /// Add a decision as of Switch::automatic, or one for each of its kind. A pure function of the facts.
    void (*decide)(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts);
};

/// The table.
OIIO::cspan<Effect> all_effects();

/// Decide on all effects of `stage`. False, with the reason in `error`, if one is switched on by name that is
/// impossible, or one off that is called for and cannot be left out.
bool decide_effects(std::vector<EffectDecision>& dst, const std::string& stage, const EffectFacts& facts,
                    const EffectSwitches& switches, std::string& error);

/// The effects that the scene calls for, that change texels, and that were left out, separated by ", ", or "".
std::string left_out(const std::vector<EffectDecision>& decisions);

/// The decisions as lines of a table: effect, on or off, expected share, reason.
std::vector<std::string> decision_lines(const std::vector<EffectDecision>& decisions);

} // namespace vmlight
