// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/string_view.h>

#include <array>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>

namespace vmlight {

/// A value to be formatted: a boolean, character, number or string. Refers to strings, without a copy.
class FormatArgument
{
public:
    using Value = std::variant<bool, char, long long, unsigned long long, float, double, std::string_view>;

    template <class T, std::enable_if_t<std::is_arithmetic_v<T>, int> = 0>
    FormatArgument(T number)
        : value(widest(number))
    {
    }
    FormatArgument(const char* text)
        : value(std::string_view(text))
    {
    }
    FormatArgument(const std::string& text)
        : value(std::string_view(text))
    {
    }
    FormatArgument(OIIO::string_view text)
        : value(std::string_view(text.data(), text.size()))
    {
    }

    Value value;

private:
    template <class T> static auto widest(T number)
    {
        if constexpr (std::is_same_v<T, bool> || std::is_same_v<T, char> || std::is_floating_point_v<T>)
            return number;
        else if constexpr (std::is_signed_v<T>)
            return static_cast<long long>(number);
        else
            return static_cast<unsigned long long>(number);
    }
};

/// format() of a number of arguments that is known at run time only.
std::string format_arguments(OIIO::string_view pattern, const FormatArgument* arguments, int count);

/// `pattern` with each "{}" replaced, in the syntax of fmt and std::format. The formatting is compiled once and not, as
/// in a header, into each file that has a message. A pattern that does not fit its arguments is a programming error:
/// throws, or ends the process.
template <class... T> std::string format(OIIO::string_view pattern, const T&... values)
{
    const std::array<FormatArgument, sizeof...(T)> arguments { FormatArgument(values)... };
    return format_arguments(pattern, arguments.data(), sizeof...(T));
}

} // namespace vmlight
