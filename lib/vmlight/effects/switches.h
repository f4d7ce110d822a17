// SPDX-License-Identifier: Apache-2.0
/// Which effects the user switched on or off: "auto", "all", or a list such as "-ground,+self-occlusion". The list may
/// begin with "auto" or "all", for the effects that it does not name.
#pragma once

#include <OpenImageIO/string_view.h>

#include <map>
#include <string>

namespace vmlight {

enum class Switch
{
    automatic, ///< simulated where it can change the picture
    on, ///< simulated
    off ///< left out
};

class EffectSwitches
{
public:
    /// False, with the reason in `error`, if a word is neither a switch nor the name of an effect of this stage (the
    /// error suggests the closest name), or an effect is named twice.
    static bool parse(EffectSwitches& dst, OIIO::string_view text, const std::string& stage, std::string& error);

    Switch of(const std::string& effect) const
    {
        const auto found = m_named.find(effect);
        return found == m_named.end() ? m_rest : found->second;
    }
    /// Whether the user named it.
    bool names(const std::string& effect) const { return m_named.count(effect) > 0; }

private:
    Switch m_rest = Switch::automatic;
    std::map<std::string, Switch> m_named;
};

} // namespace vmlight
