// SPDX-License-Identifier: Apache-2.0
/// What memory there is, for what says beforehand how much it needs. The system grants more than it has, and ends the
/// process that makes use of it.
#pragma once

#include <OpenImageIO/imageio.h>

#include <cstdint>
#include <string>

namespace vmlight {

/// Bytes that this process could get at most: what the machine, each control group (of either version) that the process
/// is in, and its own limits (RLIMIT_AS, RLIMIT_DATA) leave, whichever is least. Files that the system keeps in memory
/// count as free, and so does free swap, as much as a group (of the second version) may have of it. The largest number
/// where nothing tells.
///
/// @param root     of /proc and /sys
int64_t available_memory(const std::string& root = "");

/// Why no image of `spec` can be made in memory as float, or "". What else its making takes is not counted: what is
/// refused would never have fitted.
std::string memory_fault(const OIIO::ImageSpec& spec);

} // namespace vmlight
