// SPDX-License-Identifier: Apache-2.0
/// Animations: inputs with a file for each frame, and lightmaps of a turntable.
#pragma once

#include <vmlight/base/frames.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/stage/recipe/recipe.h>

#include <string>
#include <vector>

namespace vmlight {

/// Whether `name`, of a file or recipe, stands for a file for each frame: it has a #, and no file has that name.
bool is_sequence(const std::string& name);

/// What to say of a sequence as the input `key` where there are no frames.
std::string sequence_fault(const std::string& key, const std::string& name);

/// Which of the `frames` of a sequence have no file, as a fault, or "": before hours go into the others. "" also of
/// what is no sequence, or has a <UDIM>.
std::string missing_frames_fault(const std::string& name, const std::vector<int>& frames);

struct Animation
{
    /// Frame numbers, and whether the user gave them.
    std::vector<int> frames { 1 };
    bool has_frames = false;
    /// Degrees about y, applied after the object's own rotation.
    Ramp rotate_y;

    bool rotates() const { return rotate_y.first != 0 || rotate_y.last != 0; }

    /// Why the frames cannot be written to `output`, or "".
    std::string fault(const std::string& output) const;

    /// Why the frames of `recipe` cannot be made, or "": an input is a sequence, but there are no frames; or there are
    /// several, but nothing moves.
    std::string input_fault(const LightmapRecipe& recipe) const;

    /// The missing_frames_fault() of an input of `recipe`, or "".
    std::string missing_fault(const LightmapRecipe& recipe) const;

    /// `recipe` with the files of frame number frames[index] for inputs that are sequences: "sky.####.exr" becomes
    /// "sky.0001.exr". A file whose name really has that # is not a sequence.
    LightmapRecipe inputs_at(const LightmapRecipe& recipe, size_t index) const;

    /// The file of frame number frames[index].
    std::string path(const std::string& output, size_t index) const;

    /// `params` for frame number frames[index], with both rotations as one matrix. Sets `error` if the rotation in
    /// `params` is invalid.
    LightmapParams params_at(const LightmapParams& params, size_t index, std::string& error) const;
};

} // namespace vmlight
