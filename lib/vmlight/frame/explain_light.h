// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/frame/scene_light.h>
#include <vmlight/frame/traced_light.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/stage/make_options.h>

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight {

/// Report which effects the light of an object simulates, and why, as makelightmap --explain does: those rows that
/// frames decide on.
///
/// @param name     of the object
/// @param albedo, bounce   nullptr if no bounce is asked for; else texel_albedo(), and what traces it
/// @returns false, with the reason in `error`, if a parameter is out of range
bool explain_traced(const std::string& name, const TraceParams& trace, const OIIO::ImageBuf& map,
                    const SceneLight& light, const LightmapParams& params, const OIIO::ImageBuf* albedo,
                    BounceShading* bounce, const MakeOptions& options, std::string& error);

} // namespace vmlight
