// SPDX-License-Identifier: Apache-2.0
/// The unfiltered environment (a lobe of r = 1), reduced to the size that shading needs: for models that weight its
/// directions themselves.
#pragma once

#include <vmlight/cfem/cfem.h>

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight {

/// Reduce an environment to the size of a CFEM.
///
/// @param dst      set to a float image of R, G, B of the size `params.resolution`: each pixel the mean of `env` over
///                 its solid angle, so that all light is preserved, however small the sun. The last image of a stack
///                 (stack.h), with `vmlight:lobe` 1. Sums are in double
/// @param env, params  as for make_cfem()
/// @returns false, with the reason in `error`, if make_cfem() would.
bool make_radiance(OIIO::ImageBuf& dst, const Environment& env, const CfemParams& params, std::string& error,
                   const Progress& progress = {});

/// The image of `light` (a whole stack, or a single image) that make_radiance() made; nullptr if there is none.
const OIIO::ImageBuf* find_radiance(OIIO::cspan<OIIO::ImageBuf> light);

/// Whether `auto` may choose among all models: `light` is a stack, or the result of make_radiance().
bool has_all_light(OIIO::cspan<OIIO::ImageBuf> light);

} // namespace vmlight
