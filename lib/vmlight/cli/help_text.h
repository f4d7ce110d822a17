// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/cli/command_line.h>

#include <string>

namespace vmlight {

/// What --help prints: usage, all flags with the words that they accept, examples, exit codes. Lines are wrapped at 79
/// columns.
std::string help_text(const CommandLine& line);

} // namespace vmlight
