// SPDX-License-Identifier: Apache-2.0
#include "tables.h"

#include "row_json.h"

#include <vmlight/base/format.h>

#include <OpenImageIO/strutil.h>

namespace vmlight::cost {
namespace {

std::string cell(const std::string& text)
{
    return text.find_first_of(",\"\r\n") == std::string::npos
        ? text
        : "\"" + OIIO::Strutil::replace(text, "\"", "\"\"", true) + "\"";
}

std::string cell(int number)
{
    return format("{}", number);
}

std::string cell(double number)
{
    return format("{:.6g}", number);
}

} // namespace

std::string csv_text(const std::vector<Row>& rows)
{
    std::vector<std::string> lines, names;
    Row().visit([&](const char* name, auto&) { names.push_back(name); });
    lines.push_back(OIIO::Strutil::join(names, ","));
    for (Row row : rows) {
        std::vector<std::string> cells;
        row.visit([&](const char*, auto& value) { cells.push_back(cell(value)); });
        lines.push_back(OIIO::Strutil::join(cells, ","));
    }
    return OIIO::Strutil::join(lines, "\n") + "\n";
}

std::string json_text(const std::vector<Row>& rows, const Facts& facts, const std::vector<EffectCost>& effects)
{
    nlohmann::ordered_json json;
    for (const auto& [name, value] : facts)
        json["about"][name] = value;
    json["rows"] = nlohmann::ordered_json::array();
    for (const Row& row : rows)
        json["rows"].push_back(row_to_json(row));
    json["effects"] = nlohmann::ordered_json::array();
    for (EffectCost effect : effects) {
        nlohmann::ordered_json& object = json["effects"].emplace_back();
        effect.visit([&](const char* name, auto& value) { object[name] = value; });
    }
    // File names may contain any bytes.
    return json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

} // namespace vmlight::cost
