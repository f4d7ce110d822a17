// SPDX-License-Identifier: Apache-2.0
/// Ends the process when a test hangs or crashes, and names the test. The main of the test binaries sets it up.
#pragma once

#include <string>

namespace vmlight {

/// What the running test is trying right now, printed after the test's name when it hangs or crashes.
void set_current_case(const std::string& text);

/// Restarts the running test's time: for a test that runs many cases, each of which may take the limit.
void restart_watchdog();

/// Lets the running test take `factor` times the limit.
void extend_watchdog(int factor);

} // namespace vmlight
