// SPDX-License-Identifier: Apache-2.0
/// Flags made from parameters.
#pragma once

#include <vmlight/base/params.h>
#include <vmlight/cli/command_line.h>

#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// A flag for each parameter: `--max-distance 2` for `max_distance`, with `prefix` before its name. They set `params`,
/// which must outlive them; its values are shown as the defaults.
template <class Params>
std::vector<CommandLine::Option> options_of(const std::string& heading, Params& params, const std::string& prefix)
{
    std::vector<CommandLine::Option> options;
    Params defaults = params;
    defaults.visit([&](const char* field, auto& value, const auto& allowed, const Help& help) {
        using Allowed = std::decay_t<decltype(allowed)>;
        constexpr bool kIsFlag = std::is_same_v<Allowed, Flag>, kIsList = kTakesLines<Allowed>;
        const std::string name = field, text = value_text(value, allowed);
        CommandLine::Option& option = options.emplace_back();
        option.heading = heading;
        option.name = prefix + name;
        option.choices = choices_of(allowed);
        option.is_advanced = help.is_advanced;
        option.is_repeatable = kIsList;
        option.metavar = option.choices.empty()  ? allowed_text(allowed)
            : std::is_same_v<Allowed, ChoiceSet> ? "NAME,..."
                                                 : "NAME";
        option.help = help.text;
        option.parameter = name;
        option.allowed = allowed_value<std::decay_t<decltype(value)>>(allowed);
        if (kIsList)
            option.help += "; may be repeated";
        else if (!kIsFlag && !text.empty())
            option.help += " [" + text + "]";
        // The first occurrence of a list replaces its value, later ones add to it.
        const auto lines = std::make_shared<std::string>();
        option.take = [&params, name, lines](OIIO::string_view given, std::string& error) {
            if (kIsList)
                *lines += (lines->empty() ? "" : "\n") + std::string(given);
            return set_param(params, name, kIsList ? *lines : std::string(given), error);
        };
    });
    return options;
}

} // namespace vmlight
