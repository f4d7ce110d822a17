// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/stage/lightmap_plan.h>
#include <vmlight/stage/make_stage.h>

#include <string>

namespace vmlight {

/// All inputs of a lightmap, whole, for make_lightmap(). Keeps what `dst` already has if it is the same.
bool make_lightmap_inputs(LightmapInputs& dst, const LightmapPlan& plan, const MakeOptions& options,
                          std::string& error);

/// The whole lightmap, reported as an executable does.
bool make_lightmap_image(OIIO::ImageBuf& lightmap, const LightmapPlan& plan, const MakeOptions& options,
                         std::string& error);

} // namespace vmlight
