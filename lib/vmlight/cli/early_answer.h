// SPDX-License-Identifier: Apache-2.0
/// What a command line is answered from the description of its flags alone: help and the like, and what is wrong with
/// it whatever the files hold.
#pragma once

#include <vmlight/cli/command_line.h>
#include <vmlight/cli/exit_code.h>

#include <optional>
#include <string>

namespace vmlight {

/// Parse `argv` into `line`.
///
/// @param answer   set to the text to print, if the result is Done
/// @param error    set to what is wrong, in the words of StageCommand::parse(), if it is Usage
/// @returns nothing if there is work to do, or if only what does it can say what is wrong: a recipe has to be read, or
///          a flag's value is for its own code to judge
std::optional<ExitCode> early_answer(CommandLine& line, int argc, const char** argv, std::string& answer,
                                     std::string& error);

/// Print an answer on stdout. False, with the reason in `error`, if it cannot be written.
bool print_answer(const std::string& answer, std::string& error);

/// Print "NAME SEVERITY: text" on stderr, on one line.
void print_message(const CommandLine& line, const char* severity, const std::string& text);

/// An error of usage, with the way to the help.
std::string usage_text(const CommandLine& line, const std::string& error);

} // namespace vmlight
