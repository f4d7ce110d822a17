// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "row.h"

#include <nlohmann/json.hpp>

namespace vmlight::cost {

inline nlohmann::ordered_json row_to_json(Row row)
{
    nlohmann::ordered_json json;
    row.visit([&](const char* name, auto& value) { json[name] = value; });
    return json;
}

/// Returns false if a column is missing or has the wrong type.
inline bool row_from_json(Row& row, const nlohmann::json& json)
{
    bool good = true;
    row.visit([&](const char* name, auto& value) {
        const auto found = json.find(name);
        constexpr bool is_text = std::is_same_v<std::decay_t<decltype(value)>, std::string>;
        good = good && found != json.end() && (is_text ? found->is_string() : found->is_number());
        if (good)
            value = found->template get<std::decay_t<decltype(value)>>();
    });
    return good;
}

} // namespace vmlight::cost
