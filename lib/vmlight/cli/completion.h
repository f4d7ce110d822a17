// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/cli/command_line.h>

#include <string>

namespace vmlight {

/// Set `script` to the completion script of an executable for `shell`: "bash" or "zsh". It completes flags, the words
/// that they accept, and file names. Returns false, with the reason in `error`, for another shell.
bool print_completion(std::string& script, const CommandLine& line, const std::string& shell, std::string& error);

} // namespace vmlight
