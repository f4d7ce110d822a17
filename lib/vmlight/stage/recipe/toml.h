// SPDX-License-Identifier: Apache-2.0
/// TOML as recipes use it: the values of a table to the texts that parse_value() takes.
#pragma once

#include <vmlight/base/params.h>
#include <vmlight/base/toml_text.h>

#include <string>
#include <vector>

namespace vmlight {

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
