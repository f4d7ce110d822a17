// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace vmlight {

/// Called from any thread, but never from two at once, with the fraction of the work that is done, in [0, 1]. Return
/// false to stop: the stage then fails with the message "interrupted".
using Progress = std::function<bool(double done)>;

} // namespace vmlight
