// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight::cost {

/// Channels of a reference, in the order of make_reference().
inline const std::vector<std::string> kReferenceChannels { "R", "G", "B", "error.R", "error.G", "error.B", "coverage" };
/// Channels of a heat map.
inline const std::vector<std::string> kHeatMapChannels { "R", "G", "B", "coverage" };

/// Read an image and put its channels into the order of `names`: EXR files store them sorted. Returns false, with the
/// reason in `error`.
bool read_channels(OIIO::ImageBuf& dst, const std::string& path, const std::vector<std::string>& names,
                   std::string& error);

} // namespace vmlight::cost
