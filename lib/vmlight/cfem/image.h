// SPDX-License-Identifier: Apache-2.0
/// What the filters' sums become: pixels.
#pragma once

#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight {

/// Set `dst` to a float image of `spec` with the values `rgb`, those below 0 as 0 if `clamp`. False, with the reason in
/// `error`, if one does not fit a float.
bool set_cfem(OIIO::ImageBuf& dst, const OIIO::ImageSpec& spec, const std::vector<double>& rgb, bool clamp,
              std::string& error);

/// Say in `spec` how many values of the environment were mended, if any.
void note_mended(OIIO::ImageSpec& spec, int64_t values);

} // namespace vmlight
