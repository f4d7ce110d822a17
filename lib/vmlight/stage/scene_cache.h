// SPDX-License-Identifier: Apache-2.0
/// The scenes of vismap recipes, shared by all maps of one mesh that the process makes or has open.
#pragma once

#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/trace/bake_scene.h>

#include <string>
#include <vector>

namespace vmlight {

/// The files that a scene is made from, as they are now.
struct SceneStamps
{
    /// Of the mesh and of each occluder, see stamp_file().
    std::vector<std::string> files;
    /// Equal keys, equal scenes.
    std::string key;
};

/// False if one of the files is missing: `at` is the recipe's key that names it, `error` the reason.
bool stamp_scene(SceneStamps& dst, const VismapRecipe& recipe, std::string& at, std::string& error);

/// The scene of a recipe, whose paths hold no "<UDIM>": read and built if none of these files is in use, and shared
/// while one is, whatever its UDIM tile, resolution and samples. Nothing is kept of what no one holds. Any thread;
/// those that want the scene meanwhile wait.
///
/// @param stamps   as the files were when the caller decided to read them
/// @param built    nullptr, or set to how many seconds it took to build, files apart; 0 if it was there
/// @returns false if a file is no longer as it was, or is not what it should be, or memory runs out: `at` and `error`
///          as for stamp_scene(). The next call tries anew
bool share_scene(BakeScenePointer& dst, const VismapRecipe& recipe, const SceneStamps& stamps, int nthreads,
                 double* built, std::string& at, std::string& error);

} // namespace vmlight
