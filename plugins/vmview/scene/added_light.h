// SPDX-License-Identifier: Apache-2.0
/// Light that is traced on the processor and added to what shaders look up: suns, and one bounce.
#pragma once

#include "assets.h"

#include <vmlight/frame/traced_light.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/stage/make_options.h>

#include <string>
#include <vector>

namespace vmlight::view {

/// Of one mesh, map and light, which it keeps. One thread at a time.
class AddedLight
{
public:
    /// @param is_white the mesh sends back light as one without materials does
    AddedLight(const TraceParams& params, MeshPointer mesh, bool is_white, MapPointer map, LightPointer light);

    /// Trace it at the rotation of `params`, for a model that map and light allow.
    ///
    /// @param dst      set to three floats a texel, before the exposure; empty if there is nothing to add
    /// @returns false, with the reason in `error`, as TracedLight::light()
    bool trace(std::vector<float>& dst, const LightmapParams& params, const MakeOptions& options, std::string& error);

private:
    const MeshPointer m_mesh;
    const MapPointer m_map;
    const LightPointer m_light;
    TracedLight m_traced;
};

} // namespace vmlight::view
