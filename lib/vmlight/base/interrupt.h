// SPDX-License-Identifier: Apache-2.0
/// Ctrl-C and other signals that stop a process: exit at once, unless an output file has to be cleaned up first.
#pragma once

#include <string>

namespace vmlight {

/// Handle SIGINT, SIGTERM and SIGHUP from now on: the process exits with `exit_code` and the message
/// "NAME ERROR: interrupted". While an output is being written (DeferInterrupts) the first signal only sets
/// interrupted(); the second exits.
void catch_interrupts(const std::string& name, int exit_code);

/// Whether one of these signals arrived.
bool interrupted();

/// Ignore these signals from now on: the output is complete, and the exit code must say so.
void ignore_interrupts();

/// Make failed writes return errors instead of killing the process: SIGPIPE and SIGXFSZ are ignored from now on. Closed
/// stdin, stdout and stderr are opened on /dev/null, so that no file that is opened later gets their descriptors.
void prepare_streams();

/// While one of these exists, an interrupt does not exit: a partly written file has to be removed first.
class DeferInterrupts
{
public:
    DeferInterrupts();
    ~DeferInterrupts();
    DeferInterrupts(const DeferInterrupts&) = delete;
    DeferInterrupts& operator=(const DeferInterrupts&) = delete;
};

} // namespace vmlight
