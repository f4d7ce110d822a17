// SPDX-License-Identifier: Apache-2.0
/// A large stack for libraries that walk a file's node tree by recursion.
#pragma once

#include <functional>

namespace vmlight {

/// Run `work` on a thread with a stack of 512 MiB (only touched pages use memory) and wait for it. Exceptions reach the
/// caller. Falls back to the caller's stack if the thread cannot be created.
void run_on_deep_stack(const std::function<void()>& work);

} // namespace vmlight
