// SPDX-License-Identifier: Apache-2.0
/// Ctrl-C and its kin: the work stops where it can be stopped, and at once where there is nothing to tidy up.
#pragma once

#include <string>

namespace vmlight {

/// From now on SIGINT, SIGTERM and SIGHUP set interrupted(), or end the process with `exit_code` and the message
/// "NAME ERROR: interrupted": the first one while no output is being written, else the second.
void catch_interrupts(const std::string& name, int exit_code);

bool interrupted();

/// From now on the same signals do nothing: all is written, and the exit code must say so.
void ignore_interrupts();

/// Have a write that fails say so, to the file or pipe whose it is, and end no process: SIGPIPE and SIGXFSZ are ignored
/// from now on, and what of stdin, stdout and stderr is closed leads to /dev/null, or the next file that is opened
/// would be taken for it.
void settle_streams();

/// While one of these lives, a file is being written that an interrupt must not leave behind.
class WhileWriting
{
public:
    WhileWriting();
    ~WhileWriting();
    WhileWriting(const WhileWriting&) = delete;
    WhileWriting& operator=(const WhileWriting&) = delete;
};

} // namespace vmlight
