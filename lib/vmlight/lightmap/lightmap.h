// SPDX-License-Identifier: Apache-2.0
/// Shaded textures: a visibility map lit by a cosine-filtered environment, for any rotation of the object.
/// Source: I. Neulander, "Image-Based Diffuse Lighting Using Visibility Maps", section 4.
#pragma once

#include <vmlight/base/export.h>
#include <vmlight/base/params.h>
#include <vmlight/base/progress.h>
#include <vmlight/math/rotation.h>

#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight {

/// The words that LightmapParams::model takes.
VMLIGHT_API Choices model_choices();

struct LightmapParams
{
    /// The shading model: how a texel becomes light. `ao`: V C(R n); needs a map with normals (VismapParams::channels).
    /// `paper`: V C(R B / |B|). `lobe`: as `paper`, with the environment filtered by a lobe as wide as |B| / V implies,
    /// instead of the cosine; needs a stack (cfem/stack.h). `sh`, `mask`, `cells`: the unfiltered environment, summed
    /// over the visible part of the sky that the further channels of a map describe (VismapParams::basis); need a
    /// stack, whose last image is that environment. `auto`: the most accurate of these that map and light allow, never
    /// `ao`.
    std::string model = "auto";
    /// Rotation of the object in the environment: at most one of these three. Degrees about fixed x, then y, then z; or
    /// 9 numbers, row major, for column vectors; or w, x, y, z.
    std::vector<double> rotate, matrix, quaternion;
    /// Rotation of the environment, as `rotate`; applied after the object's.
    std::vector<double> env_rotate;
    static constexpr Range kExposure { -64, 64 };
    /// Stops: the result is multiplied by 2^exposure.
    double exposure = 0;
    /// Whether lookups in light of one colour, and products with an albedo of 1, are left out: the same result for
    /// less. Not parameters of the result, and so not in the metadata.
    bool skip_one_color = true, skip_one_albedo = true;

    template <class Visit> void visit(Visit&& field)
    {
        field("model", model, model_choices(), "Shading model");
        field("rotate", rotate, Numbers { 3 }, "Rotate the object: x,y,z in degrees about the fixed axes, x first");
        field("matrix", matrix, Numbers { 9 },
              advanced("Rotate the object by a 3x3 matrix, row major, for column vectors"));
        field("quaternion", quaternion, Numbers { 4 }, advanced("Rotate the object by a quaternion w,x,y,z"));
        field("env_rotate", env_rotate, Numbers { 3 }, "Rotate the environment: x,y,z in degrees, as for rotate");
        field("exposure", exposure, kExposure, "Exposure in stops");
    }
};

/// The rotation from object space to environment space: with the object turned by R and the environment by E, light
/// arrives along object direction w from environment direction E^-1 R w.
///
/// @returns false, with the reason in `error`, if a parameter is out of range, more than one of rotate, matrix and
///          quaternion is given, or one is not a rotation.
VMLIGHT_API bool lightmap_rotation(Rotation& dst, const LightmapParams& params, std::string& error);

/// Light a visibility map.
///
/// @param dst      set to a float image of R, G, B of the size of `vismap`, in the units of `cfem`: albedo x estimate
///                 of (1/pi) Int L(R w) vis(w) max(0, n.w) dw, the radiance that leaves a Lambertian surface. 0 where V
///                 <= 0. Where B gives no direction (no component reaches 1e-6 V), C is the mean of the CFEM over the
///                 sphere. Light of one colour is looked up nowhere: by every model it gives V times that colour.
///                 `vmlight:model` is the model that was used, "lobe+suns" where suns were added. Memory of `dst` that
///                 fits is reused. May be one of the inputs
/// @param vismap   channels `visibility`, `direction.x`, `direction.y`, `direction.z`, found by name, in any order; for
///                 the model `ao` also `normal.x`, `normal.y`, `normal.z`; for `sh`, `mask` and `cells` those of the
///                 basis
/// @param cfem     a lat-long map of R, G, B as make_cfem() makes it, of any size from 1x1. Looked up bilinearly,
///                 continuous across seam and poles: a pole has the mean of its row. Negative values are allowed. Or
///                 the images of a stack, as make_cfem_stack() makes them
/// @param albedo   nullptr, or a colour image in linear light, resized to `vismap` by a triangle filter if its size
///                 differs; a single channel serves as all three
/// @param nthreads 0 means OIIO's default. The result is the same bits for every value and every instruction set.
/// @returns false, with the reason in `dst.geterror()` and no pixels in `dst`, if a parameter is out of range; an image
///          is not what it should be, or lacks what the model reads (the message says what, and how to make it); a
///          pixel is not finite or an albedo negative (with the count and the first place); |V| > 2, more than a filter
///          that rings could cause; a map for `mask` or `cells` no longer holds whole numbers; the result is too large
///          for float; or `progress` stopped the work ("interrupted"). Not checked: that `cfem` was filtered with a
///          cosine, unless its `vmlight:stage` says otherwise.
/// Cost: about 3 ns per texel on one thread for `paper`, 1.9 to 2.4 times that of moving the bytes; `lobe` takes 1.3
/// times as long, `sh` 2 to 6 times, `mask` and `cells` 8 times (docs/accuracy.md).
VMLIGHT_API bool make_lightmap(OIIO::ImageBuf& dst, const OIIO::ImageBuf& vismap, const OIIO::ImageBuf& cfem,
                               const LightmapParams& params = {}, const OIIO::ImageBuf* albedo = nullptr,
                               int nthreads = 0, const Progress& progress = {});
VMLIGHT_API bool make_lightmap(OIIO::ImageBuf& dst, const OIIO::ImageBuf& vismap, OIIO::cspan<OIIO::ImageBuf> cfem,
                               const LightmapParams& params = {}, const OIIO::ImageBuf* albedo = nullptr,
                               int nthreads = 0, const Progress& progress = {});

} // namespace vmlight
