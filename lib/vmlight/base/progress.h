// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace vmlight {

/// Called now and then, from any thread but never from two at once, with the share of the work that is done, in [0, 1].
/// Returns false to stop: the stage then fails with the message "interrupted".
using Progress = std::function<bool(double done)>;

} // namespace vmlight
