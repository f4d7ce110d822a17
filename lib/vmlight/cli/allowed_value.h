// SPDX-License-Identifier: Apache-2.0
/// What the value of a flag may be, as far as its parameter says: enough to refuse a command line before anything else
/// is loaded.
#pragma once

#include <vmlight/base/params.h>

#include <OpenImageIO/string_view.h>

#include <string>
#include <type_traits>
#include <variant>

namespace vmlight {

struct WholeNumber
{
    Range range;
};

/// std::monostate: only the code that takes the value knows.
using AllowedValue
    = std::variant<std::monostate, Range, WholeNumber, SizeRange, Choices, ChoiceSet, Numbers, Paths, Text, Flag>;

/// That of a parameter whose value is a `Value`.
template <class Value, class Allowed> AllowedValue allowed_value(const Allowed& allowed)
{
    if constexpr (std::is_same_v<Allowed, Range> && std::is_same_v<Value, int>)
        return WholeNumber { allowed };
    else if constexpr (std::is_same_v<Allowed, Names>)
        return Paths {};
    else if constexpr (std::is_same_v<Allowed, Path>)
        return Text {}; // no command line has a zero byte
    else
        return allowed;
}

/// Whether the value is known to be accepted or not; parse_value()'s reason against it in `error`.
bool is_allowed(OIIO::string_view text, const AllowedValue& allowed, std::string& error);

} // namespace vmlight
