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
    /// How a texel becomes light. `ao`: V C(R n), which knows no direction but the normal; needs a map with normals
    /// (VismapParams::channels). `paper`: V C(R B / |B|). `lobe`: the same, with the environment filtered by a lobe as
    /// wide as |B| / V says, in place of the cosine; needs a stack (cfem_stack.h). `sh`, `mask`, `cells`: the
    /// environment itself, summed over what the further channels of a map tell to be seen (VismapParams::basis); need
    /// a stack, whose last image it is. `auto`: the best of these that the map and the light are fit for (README,
    /// "What accuracy costs").
    std::string model = "auto";
    /// The rotation of the object into the environment: one of these three, or none.
    std::vector<double> rotate, matrix, quaternion;
    /// Turns the environment instead, by the same angles; applied after the object's own rotation.
    std::vector<double> env_rotate;
    /// Stops: the result is multiplied by 2^exposure.
    double exposure = 0;

    template <class Visit> void visit(Visit&& field)
    {
        field("model", model, model_choices(), "Shading model; auto is the best that map and light are fit for");
        field("rotate", rotate, Numbers { 3 }, "Turn the object: x,y,z degrees about fixed x, then y, then z");
        field("matrix", matrix, Numbers { 9 }, "Turn the object: a rotation matrix, row major, for column vectors");
        field("quaternion", quaternion, Numbers { 4 }, "Turn the object: w,x,y,z");
        field("env_rotate", env_rotate, Numbers { 3 }, "Turn the environment: x,y,z degrees, as for rotate");
        field("exposure", exposure, Range { -64, 64 }, "Stops to brighten the result by");
    }
};

/// The rotation from object space to environment space that `params` asks for: with the object turned by R and the
/// environment by E, light arrives along object direction w from environment direction E^-1 R w.
/// False, with the reason in `error`, if a parameter is out of range, more than one of rotate, matrix, quaternion is
/// given, or one is not a rotation.
VMLIGHT_API bool lightmap_rotation(Rotation& dst, const LightmapParams& params, std::string& error);

/// Light a visibility map. About 3 ns a texel and thread by `paper`, three times what it takes to move the bytes; 1.3
/// times as long by `lobe`, 2 to 6 by `sh`, 18 by `mask` and `cells` (bench/lightmap_bench.cpp).
///
/// @param dst      set to a float image of R, G, B with the size of `vismap`: albedo x estimate of
///                 (1/pi) Int L(R w) vis(w) max(0, n.w) dw, the radiance that leaves a Lambertian surface. 0 where
///                 visibility is 0 or less. Where light is seen from all sides alike, so that there is no direction
///                 (no component of B reaches 1e-6 V), C is the mean of the CFEM over the sphere. Its `vmlight:model`
///                 is the one that was used. Memory of `dst` that fits is used again. May be one of the inputs
/// @param vismap   channels `visibility`, `direction.x`, `direction.y`, `direction.z`, found by name, in any order; for
/// the
///                 model `ao` also `normal.x`, `normal.y`, `normal.z`
/// @param cfem     a lat-long map of R, G, B as make_cfem() makes it, of any size from 1x1. Looked up bilinearly,
///                 continuous over seam and poles: a pole has the mean of the row next to it. Negative values pass.
///                 Or the levels of a stack, as make_cfem_stack() makes them
/// @param albedo   nullptr, or an initialised colour image in linear light, resized to `vismap` by a triangle filter
///                 if its size differs; one channel serves as all three
/// @param nthreads 0 means OIIO's default. The result is bit-equal for every value, whatever instructions the
///                 processor has.
/// @returns false, with the reason in `dst.geterror()`, if a parameter is out of range, an image is not what it should
///          be, a pixel of one is not finite (how many, and where the first is) or the albedo's is negative, a
///          visibility is beyond [-2, 2], further than any filter rings from [0, 1], the result is too large for float,
///          the map or the light lacks what the model reads (what, and how it is made), a map for `mask` or `cells`
///          holds no whole numbers any more, or `progress` stopped the work
///          ("interrupted"); `dst` then has no pixels. Not checked: that `cfem` was filtered with a cosine, unless its
///          `vmlight:stage` says otherwise.
VMLIGHT_API bool make_lightmap(OIIO::ImageBuf& dst, const OIIO::ImageBuf& vismap, const OIIO::ImageBuf& cfem,
                               const LightmapParams& params = {}, const OIIO::ImageBuf* albedo = nullptr,
                               int nthreads = 0, const Progress& progress = {});
VMLIGHT_API bool make_lightmap(OIIO::ImageBuf& dst, const OIIO::ImageBuf& vismap, OIIO::cspan<OIIO::ImageBuf> cfem,
                               const LightmapParams& params = {}, const OIIO::ImageBuf* albedo = nullptr,
                               int nthreads = 0, const Progress& progress = {});

} // namespace vmlight
