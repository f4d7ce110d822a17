// SPDX-License-Identifier: Apache-2.0
/// The bases `mask` and `cells`: visibility of the cells of the direction grid, packed into whole numbers
/// (math/packed_visibility.h).
#pragma once

#include <vmlight/vismap/basis.h>

namespace vmlight {

std::vector<std::string> mask_channels(const VismapParams& params);
std::vector<std::string> cells_channels(const VismapParams& params);
std::unique_ptr<BasisAccumulator> make_mask_accumulator(const VismapParams& params);
std::unique_ptr<BasisAccumulator> make_cells_accumulator(const VismapParams& params);

} // namespace vmlight
