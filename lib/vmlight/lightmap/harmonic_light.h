// SPDX-License-Identifier: Apache-2.0
/// The environment as spherical harmonics, at one rotation: what the model `sh` multiplies a transfer vector with.
#pragma once

#include <vmlight/math/rotation.h>

#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight {

struct HarmonicLight
{
    int order = 0;
    /// R, G, B and a 0 for each number of a texel: V, the components of B, then the harmonics from l = 2 on. V and B
    /// are the first two bands, up to constants, which stand here.
    std::vector<float> coefficients;
};

/// Project `radiance` onto the first `order` bands, then turn them.
///
/// @param radiance         as make_radiance() makes it
/// @param to_environment   takes directions of the object to the environment's
/// @returns false, with the reason in `error`, if the image is none that make_cfem() would take.
bool prepare_harmonics(HarmonicLight& dst, const OIIO::ImageBuf& radiance, int order, const Rotation& to_environment,
                       std::string& error);

} // namespace vmlight
