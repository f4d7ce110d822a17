// SPDX-License-Identifier: Apache-2.0
/// The light of cfem and lightmap recipes: their environment, filtered as what is lit by it asks.
#pragma once

#include <vmlight/lightmap/model.h>
#include <vmlight/stage/make_stage.h>

#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight {

/// Read or make `recipe.environment`, in scene-linear light, and filter it. One that is_large() is read as the filter
/// goes down it.
///
/// @param dst      set to one CFEM, to the levels of a stack, or to the environment as make_radiance() makes it, as
///                 `light` says; metadata name the environment
/// @returns false, with the reason in `error`, if there is no such environment, its space is not known, or the filter
///          refuses it.
template <class Recipe>
bool filter_environment(std::vector<OIIO::ImageBuf>& dst, const Recipe& recipe, ModelLight light,
                        const MakeOptions& options, std::string& error);

/// Set `dst.cfem` to what `model` reads: an environment is filtered for it, a stored CFEM is a stack or not. The light
/// of `dst` stays if it was made from the same. False, with the reason in `error` and no light in `dst`, as
/// filter_environment().
bool read_light(LightmapInputs& dst, const LightmapRecipe& recipe, const ShadingModel& model,
                const MakeOptions& options, std::string& error);

} // namespace vmlight
