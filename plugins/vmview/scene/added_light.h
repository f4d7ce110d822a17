// SPDX-License-Identifier: Apache-2.0
/// Light that is traced on the processor and added to what shaders look up: suns, and one bounce.
#pragma once

#include "assets.h"

#include <vmlight/frame/strand_light.h>
#include <vmlight/frame/traced_light.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/stage/make_options.h>

#include <memory>
#include <string>
#include <vector>

namespace vmlight::view {

/// For what was opened, and then for each of what is beside it, three floats a texel, before the exposure; empty if
/// there is nothing to add.
using AddedTexels = std::vector<std::vector<float>>;

/// Of one mesh, or strands, with what is beside it, and their maps and light, which it keeps. One thread at a time.
class AddedLight
{
public:
    /// @param is_white the mesh sends back light as one without materials does
    AddedLight(const TraceParams& params, MeshPointer mesh, bool is_white, MapPointer map, LightPointer light);

    /// Trace it at the rotation of `params`, for a model that maps and light allow.
    ///
    /// @returns false, with the reason in `error`, as TracedLight::light()
    bool trace(AddedTexels& dst, const LightmapParams& params, const MakeOptions& options, std::string& error);

private:
    bool trace_mesh(std::vector<float>& dst, const LightmapParams& params, const MakeOptions& options,
                    std::string& error);
    bool trace_strands(std::vector<float>& dst, const LightmapParams& params, const MakeOptions& options,
                       std::string& error);

    const TraceParams m_params;
    const MeshPointer m_mesh;
    const MapPointer m_map;
    const LightPointer m_light;
    std::unique_ptr<TracedLight> m_traced; // of a mesh
    StrandSuns m_suns; // of strands
    std::vector<std::unique_ptr<AddedLight>> m_beside;
};

} // namespace vmlight::view
