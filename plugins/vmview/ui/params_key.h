// SPDX-License-Identifier: Apache-2.0
/// A text that differs where parameters differ.
#pragma once

#include <vmlight/base/params.h>

#include <string>

namespace vmlight::view {

template <class Params> std::string key_of(const Params& params)
{
    std::string key;
    Params copy = params;
    copy.visit(
        [&](const char*, auto& value, const auto& allowed, const char*) { key += value_text(value, allowed) + "|"; });
    return key;
}

} // namespace vmlight::view
