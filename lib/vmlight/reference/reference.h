// SPDX-License-Identifier: Apache-2.0
/// The ray-traced reference that shading models are compared with, and its standard error.
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
    /// Pairs of rays per texel: one ray distributed like the cosine, one like the environment.
    int samples = 1024;
    int seed = 0;
    /// As CfemParams::sanitize.
    bool sanitize = false;
    /// Albedo of the mesh and its occluders, on both sides: adds what they send to a texel after one bounce. The ground
    /// is black. 0: none does. Of programs that compare only, and so no parameter.
    double bounce_albedo = 0;

    template <class Visit> void visit(Visit&& field)
    {
        field("samples", samples, Range { 2, 1 << 24 }, "Pairs of rays per texel");
        field("seed", seed, Range { 0, 2147483647 }, "Random seed: changes the noise");
        field("sanitize", sanitize, Flag {}, "Repair NaN, infinite and negative pixels of the environment");
    }
};

/// Trace (1/pi) Int L(R w) vis(w) max(0, n.w) dw for each texel of a mesh, by multiple importance sampling of the
/// cosine and the environment. Independent random numbers and no clamping: the estimate is unbiased, and its standard
/// error is that of the mean of independent pairs. Where the shading normal n differs from the geometric normal g,
/// directions below the surface are left out and the result is divided by the share of the cosine above it,
/// (1 + n.g) / 2, as in visibility maps.
///
/// @param dst      set to a float image of the size of `map`, in the units of `env`: `R`, `G`, `B`, their standard
///                 errors `error.R`, `error.G`, `error.B`, and `coverage`: 1 where a triangle covers the texel, else 0
///                 and black. Without a margin
/// @param occluders meshes in the same space that occlude and are not shaded
/// @param env      a lat-long map in linear light, as for make_cfem(): pixels are constant over their area
/// @param map      size, UDIM tile, ground and maximum distance, as for a visibility map of the same texels; its rays
///                 and measure have no effect
/// @param light    rotation and exposure; the model has no effect
/// @param nthreads 0 means OIIO's default. The result is the same bits for every value.
/// @returns false, with the reason in `dst.geterror()`, if a parameter is out of range, the mesh has no triangle or no
///          uvs, `env` lacks colour or has bad pixels, memory runs out, or `progress` stopped the work ("interrupted").
/// Source: E. Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, section 9.2 (balance
/// heuristic).
VMLIGHT_API bool make_reference(OIIO::ImageBuf& dst, const Mesh& mesh, const std::vector<Mesh>& occluders,
                                const OIIO::ImageBuf& env, const VismapParams& map, const LightmapParams& light = {},
                                const ReferenceParams& params = {}, int nthreads = 0, const Progress& progress = {});

/// The same with a scene that other maps may share. With bounced light it must have been built without
/// SceneChoice::cull: what no ray of a texel meets may still shade what lights it.
VMLIGHT_API bool make_reference(OIIO::ImageBuf& dst, const BakeScene& scene, const OIIO::ImageBuf& env,
                                const VismapParams& map, const LightmapParams& light, const ReferenceParams& params,
                                int nthreads, const Progress& progress);

} // namespace vmlight
