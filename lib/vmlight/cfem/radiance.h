// SPDX-License-Identifier: Apache-2.0
/// The environment itself, unfiltered, at the size that shading wants: what a lobe of r = 1 leaves of it. The models
/// `sh`, `mask` and `cells` weigh its directions themselves.
#pragma once

#include <vmlight/cfem/cfem.h>

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight {

/// Reduce an environment to the size of a CFEM.
///
/// @param dst      set to a float image of R, G, B of the size `params.resolution`: each pixel the mean of `env` over
///                 its solid angle, so that the light of the sphere is kept, however small the sun. A level of a stack
///                 (cfem_stack.h) with `vmlight:lobe` 1. Sums are in double
/// @param env, params  as for make_cfem()
/// @returns false, with the reason in `error`, if make_cfem() would be.
bool make_radiance(OIIO::ImageBuf& dst, const Environment& env, const CfemParams& params, std::string& error,
                   const Progress& progress = {});

/// The image of `light`, the images of a stack or that one alone, which make_radiance() made; nullptr if none is.
const OIIO::ImageBuf* find_radiance(OIIO::cspan<OIIO::ImageBuf> light);

/// Whether `auto` may choose among all models: a stack is at hand, or what make_radiance() made of an environment.
bool has_all_light(OIIO::cspan<OIIO::ImageBuf> light);

} // namespace vmlight
