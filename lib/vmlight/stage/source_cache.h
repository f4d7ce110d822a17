// SPDX-License-Identifier: Apache-2.0
/// The sources that the process has open, or had lately: who opens the same again shares them.
#pragma once

#include <vmlight/stage/pixel_source.h>

#include <cstddef>
#include <string>

namespace vmlight {

/// The source with this key that is open or was lately, or nullptr. Those that failed are forgotten.
PixelSourcePointer find_source(const std::string& key);

/// Remember `source`. Returns the one to use: another thread may have been faster.
PixelSourcePointer keep_source(PixelSourcePointer source);

/// How much the process keeps of what no one has open: 1 GiB in 64 sources unless set.
void set_source_limits(size_t bytes, size_t sources);

} // namespace vmlight
