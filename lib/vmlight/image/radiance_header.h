// SPDX-License-Identifier: Apache-2.0
/// Headers of Radiance pictures (.hdr): what they claim, and what OIIO misreads or leaves out.
#pragma once

#include <string>

namespace vmlight {

class ClaimReader;

/// Why OIIO cannot read a Radiance picture, or "": its file is too short for the scanlines that its header claims, its
/// pixels are XYZE, or they are in the run-length encoding from before 1991, which OIIO takes for plain pixels.
/// @param file read up to the end of "#?"
std::string radiance_fault(ClaimReader& file);

/// A line about header entries of the Radiance picture `path` that are not applied to the pixels (EXPOSURE, GAMMA), or
/// "".
std::string unapplied_radiance_header(const std::string& path);

} // namespace vmlight
