// SPDX-License-Identifier: Apache-2.0
/// Work that may go deep: libraries walk a file's tree by recursion.
#pragma once

#include <functional>

namespace vmlight {

/// Run `work` on a thread with half a gibibyte of stack, of which only what is used takes memory, and wait for it. What
/// it throws reaches the caller. On the caller's own stack if no such thread can be had.
void on_deep_stack(const std::function<void()>& work);

} // namespace vmlight
