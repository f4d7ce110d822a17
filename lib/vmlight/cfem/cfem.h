// SPDX-License-Identifier: Apache-2.0
/// Cosine-filtered environment maps (CFEM): for each direction n, the light of the whole hemisphere around it,
///     C(n) = (1/pi) Int L(w) max(0, n.w) dw,
/// which is irradiance / pi: a constant environment L gives C = L.
/// Source: I. Neulander, "Image-Based Diffuse Lighting Using Visibility Maps", section 3.
#pragma once

#include <vmlight/base/export.h>
#include <vmlight/base/params.h>
#include <vmlight/base/progress.h>
#include <vmlight/cfem/environment.h>

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight {

struct CfemParams
{
    /// `exact` filters by row prefix sums; `sh` projects to spherical harmonics, for comparison.
    std::string filter = "exact";
    /// Bands of the `sh` filter: order N keeps l = 0 .. N-1, N*N coefficients a channel.
    int order = 3;
    /// A lat-long map is twice as wide as high; other shapes are allowed. Measured on six scenes under four skies
    /// (bench/ladder.py): at 64x32 the error of no model is larger by .0006 than at 256x128 (that of `mask` and
    /// `cells`, which read the environment itself at this size, is less). Twice 64 is for what is not occluded, where
    /// `paper` is exact and interpolation is all that is left: at most 0.5 % of the mean light under soft skies, 2.6 %
    /// under a sun, half of that at twice the size. A stack of 128x64 also stays in the caches: `lobe` takes 1.36 times
    /// as long as `paper`, not 1.5.
    Size resolution { 128, 64 };
    /// Mend bad pixels rather than refuse them: NaN and infinity become the mean of the sound pixels among the eight
    /// around them (0 if none is), negative values become 0. Never done unasked.
    bool sanitize = false;

    template <class Visit> void visit(Visit&& field)
    {
        field("filter", filter, Choices { { "exact", "sh" } }, "How to filter: exactly, or by spherical harmonics");
        field("order", order, Range { 1, 64 }, "Bands of the sh filter; 3 is the usual nine coefficients");
        field("resolution", resolution, SizeRange { 16384, 0.5 }, "Size of the result, in pixels");
        field("sanitize", sanitize, Flag {}, "Mend NaN, infinite and negative pixels of the environment");
    }
};

/// Filter an environment with a cosine.
///
/// @param dst      set to a float image of size `resolution` of R, G, B: a lat-long map in the frame of latlong.h,
///                 sampled at pixel centres, with the `colorInteropID` and `chromaticities` of `env`. If values were
///                 mended, `vmlight:sanitized` says how many
/// @param env      a lat-long map of any size from 1x1, with channels R, G, B or one channel, in linear light. Its
///                 display window is the sphere. Its pixels are taken as constant over their area, or, if the file says
///                 `oiio:sampleborder`, as samples that lie on the seam and the poles. It is read row by row, once.
/// @param params   `exact` (the default) integrates each row of the environment in closed form along longitude and
///                 by Gauss quadrature along latitude: no ringing, nothing below 0, energy kept. Measured error,
///                 relative to the map's mean: below 1e-5 on photographed maps, below 5e-5 with a sun of one pixel. Its
///                 cost grows with the height of `env` and little with its width: 12 ms for 128x64 from 1024x512, one
///                 thread. `sh` rings, below 0 too, under small bright lights.
/// @param nthreads 0 means OIIO's default. The result is bit-equal for every value.
/// @returns false, with the reason in `dst.geterror()`, if a parameter is out of range, `env` has no colour, says that
///          it is a cube map or that its pixels are stored flipped or turned, or a pixel is NaN, infinite or negative
///          (how many, where the first is, and the flag that mends them); `dst` then has no pixels. Not checked: that
///          `env` is scene-linear, or a lat-long map at all.
VMLIGHT_API bool make_cfem(OIIO::ImageBuf& dst, const Environment& env, const CfemParams& params = {}, int nthreads = 0,
                           const Progress& progress = {});

/// What make_cfem() would make of an environment with this spec: size, channels and metadata, but for
/// `vmlight:sanitized`, which takes the pixels to know.
VMLIGHT_API OIIO::ImageSpec describe_cfem(const OIIO::ImageSpec& env, const CfemParams& params);

/// Record in a CFEM's metadata what it was made from: `vmlight:environment`, the file name of `image` (which may be a
/// recipe with ?query) without its folder.
VMLIGHT_API void record_environment(OIIO::ImageSpec& cfem, const std::string& image);

} // namespace vmlight
