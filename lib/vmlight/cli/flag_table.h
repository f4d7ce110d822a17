// SPDX-License-Identifier: Apache-2.0
/// The description of a command line as JSON, for programs: what it is called, its operands, and each flag with its
/// help and what its value may be. The executable prints it with --print-flags; the small one that users start reads
/// it.
#pragma once

#include <vmlight/cli/command_line.h>

#include <string>

namespace vmlight {

/// The table of a command line.
std::string flag_table(const CommandLine& line);

/// The command line of a table. Its flags take nothing: they can be parsed and explained only. Throws if `table` is
/// not one of flag_table().
CommandLine read_flag_table(const std::string& table);

} // namespace vmlight
