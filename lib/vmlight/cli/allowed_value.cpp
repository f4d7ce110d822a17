// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/allowed_value.h>

#include <vector>

namespace vmlight {
namespace {

template <class Value, class Allowed> bool parses(OIIO::string_view text, const Allowed& allowed, std::string& error)
{
    Value ignored {};
    return parse_value(ignored, text, allowed, error);
}

struct Check
{
    OIIO::string_view text;
    std::string& error;

    bool operator()(const std::monostate&) const { return true; }
    bool operator()(const Range& allowed) const { return parses<double>(text, allowed, error); }
    bool operator()(const WholeNumber& allowed) const { return parses<int>(text, allowed.range, error); }
    bool operator()(const SizeRange& allowed) const { return parses<Size>(text, allowed, error); }
    bool operator()(const Choices& allowed) const { return parses<std::string>(text, allowed, error); }
    bool operator()(const ChoiceSet& allowed) const { return parses<std::vector<std::string>>(text, allowed, error); }
    bool operator()(const Numbers& allowed) const { return parses<std::vector<double>>(text, allowed, error); }
    bool operator()(const Paths& allowed) const { return parses<std::vector<std::string>>(text, allowed, error); }
    bool operator()(const Text&) const { return true; }
    bool operator()(const Flag& allowed) const { return parses<bool>(text, allowed, error); }
};

} // namespace

bool is_allowed(OIIO::string_view text, const AllowedValue& allowed, std::string& error)
{
    return std::visit(Check { text, error }, allowed);
}

} // namespace vmlight
