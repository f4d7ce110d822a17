// SPDX-License-Identifier: Apache-2.0
/// Ray-tracing scenes of vismap recipes, shared by all maps of one mesh that the process makes or has open.
#pragma once

#include <vmlight/stage/scene_files.h>

#include <string>

namespace vmlight {

/// Get the scene of a recipe whose paths contain no "<UDIM>": shared while anyone holds it, whatever their UDIM tile,
/// samples and, unless the mesh is unwrapped, resolution; otherwise read and built. Callable from any thread;
/// concurrent callers wait for one build.
///
/// A part that the recipe's selection chooses shares the scene of the whole mesh, in its frame, so that its texels get
/// the same bits as in a bake of the whole; unless the part is less than 1/64 as large, where that would cost it
/// precision: then it has a scene of its own.
///
/// @param stamps   of the files when the caller decided to read them
/// @param built    nullptr, or set to the seconds spent building, without reading files; 0 if the scene was shared
/// @param at_step  hears of steps by their names
/// @returns false if a file has changed since, or cannot be used, the selection chooses nothing, or memory runs out:
///          `at` and `error` as for stamp_scene(). The next call tries again.
bool share_scene(BakeScenePointer& dst, const VismapRecipe& recipe, const SceneStamps& stamps, int nthreads,
                 double* built, std::string& at, std::string& error, const StepListener& at_step = {});

} // namespace vmlight
