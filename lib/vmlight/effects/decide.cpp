// SPDX-License-Identifier: Apache-2.0
#include <vmlight/effects/effect.h>

#include <vmlight/base/format.h>
#include <vmlight/effects/rows.h>

#include <algorithm>

namespace vmlight {
namespace {

bool apply_switch(EffectDecision& decision, const Effect& effect, const EffectSwitches& switches, std::string& error)
{
    const Switch given = switches.of(effect.name);
    if (given == Switch::on && !decision.impossible.empty() && switches.names(effect.name)) {
        error = format("effects: +{} is impossible: {}", effect.name, decision.impossible);
        return false;
    }
    if (given == Switch::off && !effect.can_be_off && decision.called_for) {
        error = format("effects: -{}: cannot be left out: {}", effect.name, decision.reason);
        return false;
    }
    if (given == Switch::on && effect.can_be_forced && decision.impossible.empty())
        decision.on = true;
    if (given == Switch::off)
        decision.on = false;
    return true;
}

// What a stage takes on its own, relative to kTracing and the like in the rows: texels, margins and files.
constexpr double kStage = 0.15;

// Of the work of all that is on.
void share_work(std::vector<EffectDecision>& decisions)
{
    double all = kStage;
    for (EffectDecision& decision : decisions) {
        decision.share = decision.on ? decision.share : 0;
        all += decision.share;
    }
    for (EffectDecision& decision : decisions)
        decision.share /= all;
}

bool changes_texels(const std::string& name)
{
    const OIIO::cspan<Effect> all = all_effects();
    return std::any_of(all.begin(), all.end(),
                       [&](const Effect& effect) { return effect.name == name && effect.changes_texels; });
}

std::string full_name(const EffectDecision& decision)
{
    return decision.which.empty() ? decision.name : format("{} \"{}\"", decision.name, decision.which);
}

std::string state_text(const EffectDecision& decision)
{
    return decision.on == decision.called_for ? (decision.on ? "on" : "off")
                                              : (decision.on ? "forced on" : "switched off");
}

} // namespace

bool decide_effects(std::vector<EffectDecision>& dst, const std::string& stage, const EffectFacts& facts,
                    const EffectSwitches& switches, std::string& error)
{
    dst.clear();
    for (const Effect& effect : all_effects()) {
        if (stage != effect.stage)
            continue;
        const size_t first = dst.size();
        effect.decide(dst, effect, facts);
        for (size_t i = first; i < dst.size(); ++i)
            if (!apply_switch(dst[i], effect, switches, error))
                return false;
    }
    share_work(dst);
    return true;
}

std::string left_out(const std::vector<EffectDecision>& decisions)
{
    std::string names;
    for (const EffectDecision& decision : decisions)
        if (decision.called_for && !decision.on && changes_texels(decision.name))
            names += (names.empty() ? "" : ", ") + full_name(decision);
    return names;
}

std::vector<std::string> decision_lines(const std::vector<EffectDecision>& decisions)
{
    std::vector<std::string> lines;
    size_t longest = 0;
    for (const EffectDecision& decision : decisions)
        longest = std::max(longest, full_name(decision).size());
    for (const EffectDecision& decision : decisions) {
        const std::string name = full_name(decision), state = state_text(decision);
        const std::string share = decision.share == 0 ? "-" : percent_text(decision.share);
        lines.push_back(format("  {}{}  {}{}  {}{}  {}", name, std::string(longest - name.size(), ' '), state,
                               std::string(std::max<size_t>(12, state.size()) - state.size(), ' '),
                               std::string(5 - std::min<size_t>(5, share.size()), ' '), share, decision.reason));
    }
    return lines;
}

} // namespace vmlight
