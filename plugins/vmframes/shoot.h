// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "request.h"

#include <vmlight/cli/main.h>

#include <string>

namespace vmlight::frames {

/// Render and write all that is asked for. False, with the reason in `error`, on failure.
bool shoot(const Request& request, StageMain& stage, std::string& error);

} // namespace vmlight::frames
