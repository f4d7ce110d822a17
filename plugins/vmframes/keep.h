// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "request.h"
#include "shot.h"

#include <string>

namespace vmlight::frames {

/// Write what was made on the way to the folder `request.sheet.keep`, which is created if necessary: each object's
/// visibility maps, the lightmaps of the last frame, and the mesh if it was unwrapped. False, with the reason in
/// `error`, on failure.
bool keep_maps(const Shot& shot, const Request& request, std::string& error);

} // namespace vmlight::frames
