// SPDX-License-Identifier: Apache-2.0
/// The basis `sh`: spherical harmonics of (1/pi) vis(w) max(0, n.w) in object space. V and B are the first two bands
/// (up to constants), so the channels start at band 2: `sh.4` ... `sh.<order^2 - 1>`. Linear, as V and B are.
/// Source: P.-P. Sloan, J. Kautz, J. Snyder, "Precomputed Radiance Transfer for Real-Time Rendering in Dynamic,
/// Low-Frequency Lighting Environments", 2002.
#pragma once

#include <vmlight/vismap/basis.h>

namespace vmlight {

std::vector<std::string> sh_channels(const VismapParams& params);
std::unique_ptr<BasisAccumulator> make_sh_accumulator(const VismapParams& params);

} // namespace vmlight
