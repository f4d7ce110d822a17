// SPDX-License-Identifier: Apache-2.0
/// The sources that the process has open or used recently, so that opening one again shares it.
#pragma once

#include <vmlight/stage/pixel_source.h>

#include <cstddef>
#include <string>

namespace vmlight {

/// The open or recently used source with this key, or nullptr. Forgets it if it failed.
PixelSourcePointer find_source(const std::string& key);

/// Remember `source`. Returns the one to use: another thread may have been first.
PixelSourcePointer keep_source(PixelSourcePointer source);

/// Limit what is kept of sources that nobody has open. Default: 1 GiB, 64 sources.
void set_source_limits(size_t bytes, size_t sources);

} // namespace vmlight
