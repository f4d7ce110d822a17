// SPDX-License-Identifier: Apache-2.0
/// Text functions for command lines and parameters, which are parsed before OpenImageIO is loaded: its library of these
/// takes ten times as long to load as all else that answers --help. They do as OIIO::Strutil does; a test compares
/// them.
#pragma once

#include <OpenImageIO/string_view.h>

#include <cstddef>
#include <string>
#include <vector>

namespace vmlight {

bool starts_with(OIIO::string_view text, OIIO::string_view start);
bool ends_with(OIIO::string_view text, OIIO::string_view end);
/// Without white space at both ends.
OIIO::string_view stripped(OIIO::string_view text);
/// The parts between each `separator`, which may be empty.
std::vector<std::string> split(OIIO::string_view text, char separator);
/// The words between white space.
std::vector<std::string> split_words(OIIO::string_view text);
/// `text` with each `from`, which is not empty, replaced by `to`.
std::string replaced(OIIO::string_view text, OIIO::string_view from, OIIO::string_view to);
/// ASCII letters in the other case; other bytes are kept.
std::string in_capitals(std::string text);
std::string in_small_letters(std::string text);
/// How many letters have to be added, left out or changed to make one of the other.
size_t edit_distance(OIIO::string_view a, OIIO::string_view b);
/// The number at the start of `text`, whatever the locale; `end`, if not null, is set to where it ends.
double number_at(const char* text, char** end = nullptr);

} // namespace vmlight
