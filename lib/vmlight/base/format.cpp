// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/format.h>

#include <OpenImageIO/strutil.h>

#include <vector>

namespace vmlight {
namespace {

fmt::format_args::format_arg argument_for_fmt(const FormatArgument& argument)
{
    return std::visit([](const auto& value) { return fmt::format_args(fmt::make_format_args(value)).get(0); },
                      argument.value);
}

} // namespace

std::string format_arguments(OIIO::string_view pattern, const FormatArgument* arguments, int count)
{
    std::vector<fmt::format_args::format_arg> converted;
    converted.reserve(count);
    for (int i = 0; i < count; ++i)
        converted.push_back(argument_for_fmt(arguments[i]));
    return fmt::vformat(fmt::string_view(pattern.data(), pattern.size()), fmt::format_args(converted.data(), count));
}

} // namespace vmlight
