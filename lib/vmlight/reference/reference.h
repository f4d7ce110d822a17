// SPDX-License-Identifier: Apache-2.0
/// The truth that shading models are measured by: light traced ray by ray, with its own standard error.
#pragma once

#include <vmlight/base/export.h>
#include <vmlight/base/params.h>
#include <vmlight/base/progress.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/vismap/vismap.h>

#include <OpenImageIO/imagebuf.h>

#include <vector>

namespace vmlight {

class BakeScene;

struct ReferenceParams
{
    /// Pairs of rays a texel: one with the density of the cosine, one with that of the environment.
    int samples = 1024;
    int seed = 0;
    /// As CfemParams::sanitize.
    bool sanitize = false;

    template <class Visit> void visit(Visit&& field)
    {
        field("samples", samples, Range { 2, 1 << 24 }, "Pairs of rays a texel");
        field("seed", seed, Range { 0, 2147483647 }, "Another seed, other noise");
        field("sanitize", sanitize, Flag {}, "Mend NaN, infinite and negative pixels of the environment");
    }
};

/// Trace (1/pi) Int L(R w) vis(w) max(0, n.w) dw for each texel of a mesh, by multiple importance sampling of the
/// cosine and the environment. Independent random numbers and no clamping: unbiased, and its standard error is that of
/// a mean of independent pairs. Where the shading normal n leans away from the surface's, directions under the surface
/// are left out and the rest is divided by the share of the cosine above it, (1 + n.g) / 2, as visibility maps do.
///
/// @param dst      set to a float image of the size that `map` asks for: `R`, `G`, `B`, their standard errors
///                 `error.R`, `error.G`, `error.B`, and `coverage`: 1 where a triangle covers the texel, else 0 and
///                 black. There is no margin
/// @param env      a lat-long map in linear light, as for make_cfem(): pixels are constant over their area
/// @param map      what a visibility map of the same texels would be made with; its rays and measure mean nothing here
/// @param light    rotation and exposure; the model means nothing here
/// @param nthreads 0 means OIIO's default. The result is bit-equal for every value.
/// @returns false, with the reason in `dst.geterror()`, if a parameter is out of range, the mesh has no triangle or no
///          uvs, `env` has no colour or bad pixels, memory runs out, or `progress` stopped the work ("interrupted").
/// Source: E. Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, section 9.2 (balance
/// heuristic).
VMLIGHT_API bool make_reference(OIIO::ImageBuf& dst, const Mesh& mesh, const std::vector<Mesh>& occluders,
                                const OIIO::ImageBuf& env, const VismapParams& map, const LightmapParams& light = {},
                                const ReferenceParams& params = {}, int nthreads = 0, const Progress& progress = {});

/// The same, of a scene that is built and that other maps may share.
VMLIGHT_API bool make_reference(OIIO::ImageBuf& dst, const BakeScene& scene, const OIIO::ImageBuf& env,
                                const VismapParams& map, const LightmapParams& light, const ReferenceParams& params,
                                int nthreads, const Progress& progress);

} // namespace vmlight
