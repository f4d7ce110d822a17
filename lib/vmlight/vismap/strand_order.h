// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/mesh/strands.h>

#include <cstdint>
#include <vector>

namespace vmlight {

/// All strands, along a space-filling curve through their roots: those that are traced one after the other meet the
/// same others, whatever their order in the file.
std::vector<uint32_t> strands_by_place(const Strands& strands);

} // namespace vmlight
