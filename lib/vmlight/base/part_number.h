// SPDX-License-Identifier: Apache-2.0
/// Parts of work that is split: their numbers, and the names of their files.
#pragma once

#include <string>
#include <vector>

namespace vmlight {

/// Part `index` of `count`, from 1 on.
struct PartNumber
{
    int index = 1, count = 1;
};

constexpr int kMostParts = 9999;

/// Parse parts such as "3/16" or "1-4,7/16": ascending, each once.
///
/// @param count    set to the number after the slash, 1 to kMostParts
/// @returns false, with the reason in `error`, if `text` is not of that form or a part is not between 1 and `count`
bool parse_parts(std::vector<int>& dst, int& count, const std::string& text, std::string& error);

/// "3/16".
std::string part_text(PartNumber part);

/// The file of a part: `WORD03of16` before the extension of `path`, with as many digits as the count has.
std::string part_path(const std::string& path, const std::string& word, PartNumber part);

/// "1-4, 7" of ascending numbers.
std::string ranges_text(const std::vector<int>& numbers);

} // namespace vmlight
