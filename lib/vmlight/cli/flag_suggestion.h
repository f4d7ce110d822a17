// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace vmlight {

/// What an error says after an unknown flag: "; did you mean --resolution or --resume?", or "" where no flag is like
/// it.
/// @param flag   as typed, with its dashes and without a value
/// @param known  the flags of the executable, with their dashes
///
/// First the flags that other renderers and bakers call so (--spp, --padding), then those that begin with `flag`, the
/// nearest by spelling, and those that have it as one of their words.
std::string flag_suggestion(const std::string& flag, const std::vector<std::string>& known);

} // namespace vmlight
