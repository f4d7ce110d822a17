// SPDX-License-Identifier: Apache-2.0
/// TOML text as recipes and scene lists use it. Only rooms that read such files include this, in sources. Nothing of
/// toml++ is linked or exported, and it throws nothing.
#pragma once

#include <OpenImageIO/string_view.h>

#include <cstdint>
#include <string>

#define TOML_HEADER_ONLY 1
#define TOML_EXCEPTIONS 0
#define TOML_ENABLE_FORMATTERS 0
#define TOML_MAX_NESTED_VALUES 8
// What it asserts of texts that are no TOML, it lets clang assume where NDEBUG is set: "[=" is then undefined
// behaviour. With neither it goes on and refuses them.
#define TOML_ASSERT(expression) static_assert(true)
#pragma push_macro("NDEBUG")
#undef NDEBUG
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

namespace vmlight {

/// `"hero.lightmap" line 3`, or the path alone if `line` is 0.
std::string at_line(const std::string& path, uint64_t line);

/// Append `text`, the bytes of the file `path`, to `dst` as TOML that is ASCII only, line for line. Two limits of
/// toml++ 3.3 make this necessary. A character outside quotes that is not ASCII is undefined behaviour, and what counts
/// as quotes depends on earlier errors: quoted characters are written as \u escapes. And a dotted key becomes nested
/// tables, which are destroyed by recursion: the dots are limited.
///
/// @returns false, with the place and reason in `error`, if the text is not UTF-8, has control characters, a character
///          outside quotes that is not ASCII, more than 100 dots outside quotes on a line, or a multi-line string. Not
///          checked: that it is TOML.
bool to_ascii(std::string& dst, OIIO::string_view text, const std::string& path, std::string& error);

/// Parse the bytes of the file `path`. False, with the place and reason in `error`, if they are not TOML or to_ascii()
/// refuses them.
bool parse_toml(toml::table& dst, OIIO::string_view text, const std::string& path, std::string& error);

} // namespace vmlight
