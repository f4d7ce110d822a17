// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "request.h"
#include "scene/loading.h"

#include <vmlight/cli/main.h>

#include <string>

namespace vmlight::view {

/// Draw frames as a window would, relit for each rotation and through the display's view, and say how long one takes.
/// False, with the reason in `error`, on failure.
bool bench_frames(const Assets& assets, const Request& request, StageMain& stage, std::string& error);

} // namespace vmlight::view
