// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace vmlight {

/// Side of the square tiles in which stages are computed, read and stored, in texels.
constexpr int kTileSize = 64;

} // namespace vmlight
