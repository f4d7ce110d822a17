// SPDX-License-Identifier: Apache-2.0
/// The inputs of a measurement: a mesh and the environments that light it.
#pragma once

#include "cost_params.h"
#include "whole_progress.h"

#include <vmlight/stage/make_stage.h>
#include <vmlight/trace/bake_scene.h>

#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight::cost {

struct Environment
{
    /// File name without folder and extension, made unique. Part of output file names.
    std::string name;
    std::string path;
    OIIO::ImageBuf image; ///< scene-linear
    std::string hash; ///< of pixels, windows and channel names
    OIIO::ImageBuf reference;
    std::string reference_key;
};

struct Inputs
{
    BakeScenePointer scene;
    std::vector<Environment> environments;

    /// Text that identifies the mesh and its occluders, for keys.
    std::string scene_text() const;
};

/// Read the mesh and the environments, and convert the environments to scene-linear, as makevismap and makecfem do.
///
/// @param mesh     the mesh and its occluders; bake parameters are ignored
/// @param light    colour space, OCIO config, layer and layout of all environments
/// @returns false, with the reason in `error`, if an input is invalid
bool read_inputs(Inputs& dst, const VismapRecipe& mesh, const std::vector<std::string>& environments,
                 const CfemRecipe& light, const MakeOptions& options, std::string& error);

/// Ray trace the reference under each environment, or reuse the one that an earlier run with the same inputs left in
/// `folder`. Unreadable files and those of another size are traced again.
///
/// @returns false, with the reason in `error`, if an environment has invalid pixels, the mesh covers or the light
///          reaches too few texels, a file cannot be written, or the work was interrupted
bool trace_references(Inputs& inputs, const CostParams& params, const std::string& folder, const MakeOptions& options,
                      WholeProgress& progress, std::string& error);

/// Bake parameters that give the texels of the reference.
VismapParams reference_map(const CostParams& params);

} // namespace vmlight::cost
