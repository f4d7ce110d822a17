// SPDX-License-Identifier: Apache-2.0
/// Texture coordinates for meshes that have none: an atlas of charts, each a piece of the surface laid flat.
#pragma once

#include <vmlight/base/export.h>
#include <vmlight/mesh/mesh.h>

#include <cstdint>
#include <string>

namespace vmlight {

struct UnwrapParams
{
    /// Texels of the map that the atlas is for.
    int width = 1024, height = 1024;
    /// Texels that a bake fills around each chart, which no other chart may reach; -1, to fill the whole map, counts as
    /// 16.
    int margin = 16;
    /// 0 means OIIO's default. The result does not depend on it.
    int nthreads = 0;
};

struct UnwrapReport
{
    int64_t charts = 0;
    /// Of the texels of the map, which the charts cover.
    double coverage = 0;
    /// Texels per unit of length, where nothing is stretched; the same for all charts.
    double density = 0;
    /// The L2 stretch of the whole atlas: the root mean square, over the surface, of how many units of length one texel
    /// spans, relative to an atlas without distortion. 1 at best. Source: P. Sander, J. Snyder, S. Gortler, H. Hoppe,
    /// "Texture Mapping Progressive Meshes", SIGGRAPH 2001, section 3.
    double stretch = 1;
    /// Triangles without area: their three corners are in one point in UV.
    int64_t without_area = 0;
    /// Triangles so thin that nothing of them is left in the steps of 2^-24 that UVs have.
    int64_t too_thin = 0;
    double seconds = 0;
};

/// Replace the UVs of `mesh` by an atlas in [0, 1]: charts that neither overlap nor fold, none of them mirrored, all at
/// one texel density, and at least `margin` texels apart. Vertices are split where charts meet, and ordered by first
/// use. Triangles keep their order, materials, nodes and normals. Edges of more than two triangles are where charts
/// end, except between the two that continue each other best. Positions are only read: corners that agree bit for bit
/// meet.
///
/// @returns false, with the reason in `error` and `mesh` as it was, if it fails check_mesh() or no triangle has an
/// area,
///          or if the charts do not fit into the map with that margin
VMLIGHT_API bool unwrap_mesh(Mesh& mesh, const UnwrapParams& params, UnwrapReport* report, std::string& error);

} // namespace vmlight
