// SPDX-License-Identifier: Apache-2.0
#include <vmlight/effects/effect.h>

#include <vmlight/base/format.h>

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
    if (given == Switch::off && !effect.can_be_off) {
        error = format("effects: -{}: cannot be left out: {}", effect.name, decision.reason);
        return false;
    }
    if (given == Switch::on && decision.impossible.empty())
        decision.on = true;
    if (given == Switch::off) {
        decision.on = false;
        decision.share = 0;
    }
    return true;
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
    return true;
}

std::string left_out(const std::vector<EffectDecision>& decisions)
{
    std::string names;
    for (const EffectDecision& decision : decisions)
        if (decision.called_for && !decision.on)
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
        const std::string share = decision.share == 0 ? "-"
            : decision.share < 0.01                   ? "< 1 %"
                                                      : format("{:.0f} %", 100 * decision.share);
        lines.push_back(format("  {}{}  {}{}  {}{}  {}", name, std::string(longest - name.size(), ' '), state,
                               std::string(std::max<size_t>(12, state.size()) - state.size(), ' '),
                               std::string(5 - std::min<size_t>(5, share.size()), ' '), share, decision.reason));
    }
    return lines;
}

} // namespace vmlight
