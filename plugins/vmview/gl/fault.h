// SPDX-License-Identifier: Apache-2.0
/// What OpenGL finds wrong with our calls. A wrong call is a defect: whoever draws asks at the end, and fails.
#pragma once

#include <string>

namespace vmlight::view {

/// Let the current context report wrong calls as they are made, where it can (KHR_debug in a debug context).
void watch_gl();

/// The first wrong call since the last question, in the driver's words, or "".
std::string gl_fault();

} // namespace vmlight::view
