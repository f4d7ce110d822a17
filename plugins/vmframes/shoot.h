// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "frames_params.h"

#include <vmlight/cli/main.h>

#include <string>

namespace vmlight::frames {

/// What is wrong with the request as a whole, or "".
std::string request_fault(const Request& request);

/// Render and write all that is asked for. False, with the reason in `error`, on failure.
bool shoot(const Request& request, StageMain& stage, std::string& error);

} // namespace vmlight::frames
