// SPDX-License-Identifier: Apache-2.0
/// Stacks: one environment filtered by lobes of several widths, for models that know how wide the visible part of the
/// sky is. A level is filtered with the power lobe
///     K(w) = (s + 1) / (2 pi) max(0, w.d)^s,
/// whose mean direction has the length r = (s + 1) / (s + 2): r = 2/3 is s = 1, the cosine, and so the CFEM; r = 1/2 is
/// s = 0, the mean over the hemisphere around d.
/// Source: the recurrence of power_lobe_eigenvalue() follows from that of the Legendre polynomials; s = 1 gives the
/// spectrum of R. Ramamoorthi and P. Hanrahan, "An Efficient Representation for Irradiance Environment Maps", 2001.
#pragma once

#include <vmlight/cfem/cfem.h>

#include <OpenImageIO/imagebuf.h>

#include <cmath>
#include <string>
#include <vector>

namespace vmlight {

/// Lobes of a stack. The first is the CFEM, the second r = 1/2; from the third on r grows.
constexpr int kStackLevels = 9;
/// Images of a stack: its lobes, and last the unfiltered environment (radiance.h), r = 1.
constexpr int kStackImages = kStackLevels + 1;
/// Above r = 2/3, levels are evenly spaced in sqrt(1 - r), at half the distance between r = 1/2 and 2/3.
constexpr double kStackStep = 0.064878256; // (sqrt(1/2) - sqrt(1/3)) / 2

/// r of an image.
inline double stack_lobe(int level)
{
    if (level == kStackLevels)
        return 1;
    if (level < 2)
        return level == 0 ? 2.0 / 3 : 0.5;
    const double x = std::sqrt(1.0 / 3) - (level - 1) * kStackStep;
    return 1 - x * x;
}

/// The exponent s of the power lobe whose mean direction has length r, from 1/2 up.
inline double power_lobe_exponent(double r)
{
    return (2 * r - 1) / (1 - r);
}

/// The factor by which the power lobe of exponent `s` scales band `l`: 1, r, then (s - l + 2) / (s + l + 1) times that
/// of band l - 2.
VMLIGHT_API double power_lobe_eigenvalue(int l, double s);

/// Filter an environment with all lobes of a stack.
///
/// @param dst      set to kStackImages float images of R, G, B: lat-long maps like those of make_cfem(), each with its
///                 r as `vmlight:lobe` (a float), `vmlight:stack` = "true", and its own `oiio:subimagename`. The first
///                 equals the result of make_cfem() bit for bit, the last is the environment reduced to
///                 `params.resolution`. Every level of a constant environment is that constant; no value is below 0
/// @param env, params, nthreads, progress  as for make_cfem(); `env` is read several times
/// @param error    set to the reason on failure
/// @returns false if make_cfem() would; `dst` is then empty.
/// The first two levels are exact. The others come from one projection onto 32 bands of spherical harmonics, clamped
/// at 0. Their error against quadrature, relative to the map's mean, is below 1e-3 under a sun of one texel, except for
/// the narrowest: 8e-3, which is 1e-4 of its own peak. With 16 bands the narrowest lobe would ring by a fifth of its
/// peak. Cost: 4.6 to 5 times that of the CFEM alone (1024x512 to 128x64).
VMLIGHT_API bool make_cfem_stack(std::vector<OIIO::ImageBuf>& dst, const Environment& env, const CfemParams& params,
                                 std::string& error, int nthreads = 0, const Progress& progress = {});

/// The same without the last image.
VMLIGHT_API bool make_lobes(std::vector<OIIO::ImageBuf>& dst, const Environment& env, const CfemParams& params,
                            std::string& error, int nthreads = 0, const Progress& progress = {});

/// Size, channels and metadata of image `level` of the stack of an environment with this spec.
VMLIGHT_API OIIO::ImageSpec describe_cfem_level(const OIIO::ImageSpec& env, const CfemParams& params, int level);

/// Whether `levels` are a stack instead of a single CFEM: several images, the first with `vmlight:stack` = "true".
VMLIGHT_API bool is_stack(OIIO::cspan<OIIO::ImageBuf> levels);

} // namespace vmlight
