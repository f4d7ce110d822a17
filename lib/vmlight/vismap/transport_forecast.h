// SPDX-License-Identifier: Apache-2.0
/// What light transport is going to take, from some of a map's texels.
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/vismap/normal_map.h>
#include <vmlight/vismap/transport_params.h>
#include <vmlight/vismap/vismap.h>

#include <OpenImageIO/span.h>

namespace vmlight {

/// Of LightTransport::prepare(); exact for small maps, else within a factor of 1.5 or so.
struct TransportForecast
{
    double rays = 0;
    double points = 0; ///< of LightTransport::points()
};

/// Trace the rays of up to 16384 texels, evenly over those that something blocks the view of. The parameters are those
/// of LightTransport::prepare(), which have been checked; not counted are the rays that it traces again with the
/// pattern of the bake. False if `progress` stopped the work.
bool forecast_transport(TransportForecast& dst, const BakeScenePointer& scene, const VismapParams& map,
                        OIIO::cspan<float> visibility, const TransportParams& params, int nthreads,
                        const Progress& progress, const NormalMapPointer& normal_map);

} // namespace vmlight
