// SPDX-License-Identifier: Apache-2.0
/// TOML as recipes use it: text to a table, and its values to the texts that parse_value() takes.
/// Only this room includes toml++. Nothing of it is linked or exported, and it throws nothing.
#pragma once

#include <vmlight/base/params.h>

#include <cstdint>
#include <string>
#include <vector>

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

// Set `text` to what parse_value() reads as the value of `node`, one overload per kind of parameter. False, with the
// reason in `reason`, if `node` is of another type.
bool node_text(std::string& text, const toml::node& node, const int&, const Range& allowed, std::string& reason);
bool node_text(std::string& text, const toml::node& node, const double&, const Range& allowed, std::string& reason);
bool node_text(std::string& text, const toml::node& node, const Size&, const SizeRange&, std::string& reason);
bool node_text(std::string& text, const toml::node& node, const std::string&, const Choices&, std::string& reason);
bool node_text(std::string& text, const toml::node& node, const std::vector<std::string>&, const ChoiceSet&,
               std::string& reason);
bool node_text(std::string& text, const toml::node& node, const std::string&, const Text&, std::string& reason);
bool node_text(std::string& text, const toml::node& node, const std::string&, const Path&, std::string& reason);
bool node_text(std::string& text, const toml::node& node, const std::vector<std::string>&, const Paths&,
               std::string& reason);
bool node_text(std::string& text, const toml::node& node, const std::vector<std::string>&, const Names&,
               std::string& reason);
bool node_text(std::string& text, const toml::node& node, const std::vector<double>&, const Numbers& allowed,
               std::string& reason);
bool node_text(std::string& text, const toml::node& node, const bool&, const Flag&, std::string& reason);

} // namespace vmlight
