// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/cli/command_line.h>

#include <string>

namespace vmlight {

/// The man page (section 1) of an executable, in roff with the man macros. It has no date: equal sources give equal
/// bytes.
std::string man_page(const CommandLine& line);

/// Text that roff prints as it is: no escapes, no hyphens for '-', no requests at the start of a line.
std::string roff_text(const std::string& text);

} // namespace vmlight
