// SPDX-License-Identifier: Apache-2.0
/// Pictures and measurements without a window or a display server.
#pragma once

#include "request.h"
#include "scene/loading.h"

#include <vmlight/cli/main.h>

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight::view {

/// Render the picture of `request` on a context of its own: scene-linear R, G, B times alpha and A, with its exposure,
/// tagged with the space of the light. False, with the reason in `error`, on failure.
bool render_headless(OIIO::ImageBuf& dst, const Assets& assets, const Request& request, std::string& error);

/// What --headless and -o ask for: read, render, write; and --bench. False, with the reason in `error`, on failure.
bool run_headless(const Request& request, StageMain& stage, std::string& error);

} // namespace vmlight::view
