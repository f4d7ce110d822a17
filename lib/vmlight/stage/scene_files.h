// SPDX-License-Identifier: Apache-2.0
/// The mesh and the occluders that a vismap recipe names.
#pragma once

#include <vmlight/base/file_stamp.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/uv/unwrap.h>

#include <string>
#include <vector>

namespace vmlight {

/// Fingerprints of the files that a scene is built from.
struct SceneStamps
{
    /// stamp_file() of the mesh, then of each occluder.
    std::vector<std::string> files;
    /// Equal keys, equal scenes of whole meshes.
    std::string key;
};

/// False if a file is missing: `at` is the recipe key that names it, `error` the reason.
bool stamp_scene(SceneStamps& dst, const VismapRecipe& recipe, std::string& at, std::string& error);

/// Read file `index` of a recipe with its cut-outs: the mesh if 0, else an occluder. Notes all that it opens in
/// `files`. False if it has changed since `stamps` or cannot be read: `at` and `error` as for stamp_scene().
bool read_scene_file(Mesh& dst, std::vector<FileStamp>& files, const VismapRecipe& recipe, const SceneStamps& stamps,
                     size_t index, const StepListener& at_step, std::string& at, std::string& error);

/// How the recipe's mesh is unwrapped, if it asks for it.
UnwrapParams unwrap_params(const VismapRecipe& recipe, int nthreads);

} // namespace vmlight
