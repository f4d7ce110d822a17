// SPDX-License-Identifier: Apache-2.0
/// The words of `vmlight WORD ...`, and what is printed of them.
#pragma once

#include <string>
#include <vector>

namespace vmlight::front {

struct Command
{
    const char *word, *executable, *help;
};

const std::vector<Command>& commands();
/// nullptr if there is none.
const Command* find_command(const std::string& word);
/// Why there is none: the nearest, and all.
std::string unknown_command(const std::string& word);

std::string help_text();
std::string man_page();
/// False, with the reason in `error`, if `shell` is neither bash nor zsh.
bool completion(std::string& script, const std::string& shell, std::string& error);

} // namespace vmlight::front
