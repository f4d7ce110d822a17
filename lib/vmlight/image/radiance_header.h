// SPDX-License-Identifier: Apache-2.0
/// Headers of Radiance pictures (.hdr): what OIIO misreads or leaves out.
#pragma once

#include <string>

namespace vmlight {

/// Why OIIO cannot read the Radiance picture `path`, or "": its pixels are XYZE, or in the run-length encoding from
/// before 1991, which OIIO takes for plain pixels. "" for any other file.
std::string radiance_fault(const std::string& path);

/// A line about header entries that are not applied to the pixels (EXPOSURE, GAMMA), or "".
std::string unapplied_radiance_header(const std::string& path);

} // namespace vmlight
