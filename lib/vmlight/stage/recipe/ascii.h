// SPDX-License-Identifier: Apache-2.0
/// A recipe's text made safe for its parser.
/// toml++ 3.3 has undefined behaviour where a character that is not ASCII stands outside quotes, and what it takes for
/// quotes depends on what is wrong before them. So it is given ASCII alone: in quotes, \u says the rest. It also makes
/// a table of each part of a dotted key, one in the other, which it takes down by recursion: hence the limit on dots.
/// What is refused for these is no TOML either, or of no use in a recipe.
#pragma once

#include <OpenImageIO/string_view.h>

#include <cstdint>
#include <string>

namespace vmlight {

/// `"hero.lightmap" line 3`, or the path alone if `line` is 0.
std::string at_line(const std::string& path, uint64_t line);

/// Append `text`, the bytes of the file `path`, to `dst` as TOML of ASCII alone, line for line. False, with the place
/// and reason in `error`, if it is not UTF-8, has control characters, a character outside quotes that is not ASCII,
/// more than 100 dots outside quotes on a line, or a text of several lines. Not checked: that it is TOML.
bool to_ascii(std::string& dst, OIIO::string_view text, const std::string& path, std::string& error);

} // namespace vmlight
