// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "row.h"

#include <OpenImageIO/span.h>

#include <string>
#include <vector>

namespace vmlight::cost {

/// What is true of all rows, by name.
using Facts = std::vector<std::pair<std::string, std::string>>;

/// A line of names, then one a row: numbers with a point, whatever the locale; texts in quotes where they must be.
std::string csv_text(const std::vector<Row>& rows);

/// {"about": {facts}, "rows": [{column: value}]}
std::string json_text(const std::vector<Row>& rows, const Facts& facts);

} // namespace vmlight::cost
