// SPDX-License-Identifier: Apache-2.0
/// The model `sh`: gain max(0, sum_i T_i c_i), no brighter than the brightest point of the CFEM, where T are the
/// numbers of a texel (V, B and the harmonics from band 2 on of (1/pi) vis(w) max(0, n.w)) and c the light's. Linear in
/// the texel but for the clamps, which the missing bands call for. 0 where V <= 0. Source: P.-P. Sloan, J. Kautz, J.
/// Snyder, "Precomputed Radiance Transfer for Real-Time Rendering in Dynamic, Low-Frequency Lighting Environments",
/// 2002, section 4.
#pragma once

#include <vmlight/lightmap/harmonic_sums.h>
#include <vmlight/lightmap/model_shader.h>

namespace vmlight {

/// Project `radiance` onto the first `bands` bands, then rotate them.
///
/// @param radiance         as make_radiance() makes it
/// @param to_environment   rotates directions from object to environment space
/// @returns false, with the reason in `error`, if make_cfem() would refuse the image.
bool build_harmonic_light(HarmonicLight& dst, const OIIO::ImageBuf& radiance, int bands, const Rotation& to_environment,
                          std::string& error);

/// V, B and the harmonics of all complete bands in the map; of three bands at least, so that a map without them lacks
/// a channel.
std::vector<std::string> sh_model_channels(const OIIO::ImageSpec& vismap);
bool has_sh(const OIIO::ImageSpec& vismap);
std::unique_ptr<ModelShader> prepare_sh(const ModelInput& input, std::string& error);

} // namespace vmlight
