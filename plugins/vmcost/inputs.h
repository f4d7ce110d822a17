// SPDX-License-Identifier: Apache-2.0
/// What is measured: one mesh, and the environments that light it.
#pragma once

#include "cost_params.h"

#include <vmlight/image/color.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/trace/bake_scene.h>

#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight::cost {

struct Environment
{
    /// Of its file, without folder and extension; made unique. Part of the names of files.
    std::string name;
    std::string path;
    OIIO::ImageBuf image; ///< scene-linear
    std::string hash; ///< of its pixels, their frame and what they sample
    OIIO::ImageBuf reference;
    std::string reference_key;
};

struct Inputs
{
    BakeScenePointer scene;
    std::vector<Environment> environments;

    /// Text that tells all of the mesh and what casts on it.
    std::string scene_text() const;
};

/// Read the mesh and the environments and convert these to scene-linear, as makevismap and makecfem do.
///
/// @param mesh     with its occluders; what it says of the bake means nothing here
/// @returns false, with the reason in `error`, if one of them is not what it should be
bool read_inputs(Inputs& dst, const VismapRecipe& mesh, const std::vector<std::string>& environments,
                 const ColorSettings& color, const MakeOptions& options, std::string& error);

/// Trace the light on each texel under each environment, or read what an earlier run traced from the same inputs and
/// left in `folder`. What is there but cannot be read, or is of another size, is traced anew.
///
/// @returns false, with the reason in `error`, if an environment has bad pixels, the mesh covers too few texels or
///          light falls on too few or none of them, a file cannot be written, or the work was stopped
bool trace_references(Inputs& inputs, const CostParams& params, const std::string& folder, const MakeOptions& options,
                      std::string& error);

/// The texels of the reference: what a bake at its size would be asked for.
VismapParams reference_map(const CostParams& params);

} // namespace vmlight::cost
