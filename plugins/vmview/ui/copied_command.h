// SPDX-License-Identifier: Apache-2.0
/// Command lines that make what a window shows.
#pragma once

#include "view_state.h"

#include <string>

namespace vmlight::view {

/// The makelightmap line that lights the map as it is shown, with `model`; without the bounce, for which it would need
/// the albedo in the map's UVs.
std::string makelightmap_command(const Request& request, const ViewState& state, const std::string& model);
/// The vmframes line that renders the picture. Its camera frames the object itself: the same angles, and, unless the
/// view was zoomed or moved, the whole object.
std::string vmframes_command(const Request& request, const ViewState& state, const std::string& model);

/// A word as a POSIX shell takes it.
std::string shell_word(const std::string& text);

} // namespace vmlight::view
