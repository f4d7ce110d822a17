// SPDX-License-Identifier: Apache-2.0
/// The light that a shading model reads, made from an environment.
#pragma once

#include <vmlight/cfem/cfem.h>
#include <vmlight/lightmap/model.h>

#include <string>
#include <vector>

namespace vmlight {

/// Filter `env` into the images of one ModelLight: a CFEM, a whole stack, or the unfiltered environment at the size of
/// `params`.
///
/// @returns false, with the reason in `error`, if make_cfem() would refuse `env` or `progress` stopped it.
bool make_model_light(std::vector<OIIO::ImageBuf>& dst, const Environment& env, const CfemParams& params,
                      ModelLight light, std::string& error, int nthreads = 0, const Progress& progress = {});

} // namespace vmlight
