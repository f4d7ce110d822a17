// SPDX-License-Identifier: Apache-2.0
/// Cosine-filtered environment maps (CFEM): the light that each direction n gathers from the hemisphere around it,
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

/// The words that CfemParams::kernel takes.
VMLIGHT_API Choices kernel_choices();

struct CfemParams
{
    /// `cosine`: C(n) as above. `strand`: the light that a strand with the tangent t gathers from the whole sphere,
    ///     S(t) = (1/pi^2) Int L(w) sin(t, w) dw,
    /// which is the mean of C(n) over all n across t: a constant environment L gives S = L. Its `exact` filter is by
    /// 128 bands of harmonics: under a single point of light it errs by at most .8 % of the largest S. A key of cfem
    /// recipes alone, since a lightmap follows its visibility map.
    std::string kernel = "cosine";
    /// `exact` integrates by row prefix sums; `sh` projects onto spherical harmonics, for comparison.
    std::string filter = "exact";
    /// Bands of the `sh` filter: N keeps l = 0 .. N-1, N*N coefficients per channel.
    int order = 3;
    /// Pixels. A lat-long map is twice as wide as it is high; other shapes are allowed. Measured on six scenes under
    /// four skies (bench/ladder.py): going from 256x128 to 64x32 adds at most .0006 to the error of any model (and
    /// reduces that of `mask` and `cells`, which read the environment at this size). The default is twice that for
    /// the sake of unoccluded texels, where `paper` is exact and only interpolation errs: by at most 0.5 % of the mean
    /// light under soft skies and 2.6 % under a sun, and half of that at 256x128. A stack of 128x64 also stays in the
    /// caches: `lobe` then takes 1.36 times as long as `paper`, instead of 1.5.
    Size resolution { 128, 64 };
    /// Repair bad pixels instead of refusing the image: NaN and infinity become the mean of the valid pixels among
    /// their eight neighbours (0 if there are none), negative values become 0.
    bool sanitize = false;
    /// Whether an environment of one colour, which no filter changes, is not filtered: the same result for less. Not a
    /// parameter of the result, and so not in the metadata.
    bool skip_one_color = true;

    template <class Visit> void visit(Visit&& field)
    {
        field("filter", filter,
              Choices { { { "exact", "closed-form integration: no ringing" },
                          { "sh", "spherical harmonics, for comparison: rings near bright lights" } } },
              advanced("How to apply the cosine filter"));
        field("order", order, Range { 1, 64 },
              advanced("Number of bands of the filter sh; 3 is the usual 9 coefficients"));
        field("resolution", resolution, SizeRange { 16384, 0.5 }, "Size of the filtered environment in pixels");
        field("sanitize", sanitize, Flag {}, "Repair NaN, infinite and negative pixels of the environment");
    }
};

/// Filter an environment with the cosine, or the kernel of strands.
///
/// @param dst      set to a float image of R, G, B of `params.resolution` pixels: a lat-long map in the frame of
///                 latlong.h, sampled at pixel centres, in the units of `env`, with its `colorInteropID` and
///                 `chromaticities`. If values were repaired, `vmlight:sanitized` holds their count
/// @param env      a lat-long map of any size from 1x1, with channels R, G, B or a single one, in linear light. The
///                 display window spans the sphere. Pixels are constant over their area, or, if the file has
///                 `oiio:sampleborder`, samples whose first and last rows and columns are on the poles and the seam.
///                 Read row by row: once, after a look at the first rows that ends at a second colour.
/// @param params   `exact` (the default) integrates each row of the environment in closed form along longitude and
///                 by Gauss quadrature along latitude: no ringing, nothing below 0, energy preserved. Measured error,
///                 relative to the map's mean: below 1e-5 on photographed maps, below 5e-5 with a sun of one pixel. Its
///                 cost grows with the height of `env` and little with its width: 12 ms for 128x64 from 1024x512, one
///                 thread. `sh` rings under small bright lights, and can go below 0. An environment of one colour has
///                 a CFEM of that colour, to the last bit.
/// @param nthreads 0 means OIIO's default. The result is the same bits for every value.
/// @returns false, with the reason in `dst.geterror()` and no pixels in `dst`, if a parameter is out of range, there is
///          no such kernel, `env`
///          has no colour, is marked as a cube map or as flipped or rotated, a pixel is NaN, infinite or negative (the
///          message has the count, the first place and the flag that repairs them), a result does not fit a float,
///          memory runs out, or `progress` stopped the work ("interrupted"). Not checked: that `env` is
///          scene-linear, or a lat-long map at all.
VMLIGHT_API bool make_cfem(OIIO::ImageBuf& dst, const Environment& env, const CfemParams& params = {}, int nthreads = 0,
                           const Progress& progress = {});

/// Size, channels and metadata of the CFEM of an environment with this spec, except `vmlight:sanitized`, which depends
/// on the pixels.
VMLIGHT_API OIIO::ImageSpec describe_cfem(const OIIO::ImageSpec& env, const CfemParams& params);

/// Set `vmlight:environment` to the file name of `image` (which may be a recipe with ?query) without its folder.
VMLIGHT_API void record_environment(OIIO::ImageSpec& cfem, const std::string& image);

} // namespace vmlight
