// SPDX-License-Identifier: Apache-2.0
#include <vmlight/effects/switches.h>

#include <vmlight/base/format.h>
#include <vmlight/base/params.h>
#include <vmlight/effects/effect.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <vector>

namespace vmlight {

bool EffectSwitches::parse(EffectSwitches& dst, OIIO::string_view text, const std::string& stage, std::string& error)
{
    std::vector<std::string> names;
    for (const Effect& effect : all_effects())
        if (effect.stage == stage)
            names.push_back(effect.name);
    EffectSwitches parsed;
    bool first = true;
    for (const std::string& part : OIIO::Strutil::splits(text, ",")) {
        const std::string word(OIIO::Strutil::strip(part));
        const std::string name = word.substr(std::min<size_t>(1, word.size()));
        const bool is_rest = word == "auto" || word == "all";
        if (is_rest && first) {
            parsed.m_rest = word == "all" ? Switch::on : Switch::automatic;
        } else if (is_rest) {
            error = format("\"{}\" must be the first word", word);
            return false;
        } else if (word.empty() || (word[0] != '+' && word[0] != '-')) {
            error = format("\"{}\" is not a switch: auto, all, or + or - before the name of an effect: {}", word,
                           OIIO::Strutil::join(names, ", "));
            return false;
        } else if (std::find(names.begin(), names.end(), name) == names.end()) {
            const std::string near = nearest_name(name, names);
            error
                = format("\"{}\" is not an effect{} The effects are {}", name,
                         near.empty() ? "." : format(": did you mean \"{}\"?", near), OIIO::Strutil::join(names, ", "));
            return false;
        } else if (!parsed.m_named.emplace(name, word[0] == '+' ? Switch::on : Switch::off).second) {
            error = format("\"{}\" is named twice", name);
            return false;
        }
        first = false;
    }
    dst = parsed;
    return true;
}

} // namespace vmlight
