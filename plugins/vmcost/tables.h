// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "effects.h"
#include "row.h"

#include <OpenImageIO/span.h>

#include <string>
#include <vector>

namespace vmlight::cost {

/// Facts about all rows, by name.
using Facts = std::vector<std::pair<std::string, std::string>>;

/// A header line, then one line per row. Numbers have a decimal point in all locales; text is quoted where necessary.
std::string csv_text(const std::vector<Row>& rows);

/// {"about": {facts}, "rows": [{column: value}], "effects": [{column: value}]}
std::string json_text(const std::vector<Row>& rows, const Facts& facts, const std::vector<EffectCost>& effects = {});

} // namespace vmlight::cost
