// SPDX-License-Identifier: Apache-2.0
/// Strands and their occluders, from the files of a recipe into a ray-tracing scene.
#pragma once

#include <vmlight/base/file_stamp.h>
#include <vmlight/stage/make_options.h>
#include <vmlight/stage/scene_cache.h>
#include <vmlight/trace/strand_scene.h>
#include <vmlight/vismap/strand_map.h>

#include <string>
#include <vector>

namespace vmlight {

/// Read the strands of a recipe and lay them out. Notes what it opens in `files`. False if the file cannot be read, has
/// changed since `stamps`, or its map would be too large: `at` is the recipe's key, `error` the reason.
bool read_strand_file(Strands& dst, StrandLayout& layout, std::vector<FileStamp>& files, const VismapRecipe& recipe,
                      const SceneStamps& stamps, std::string& at, std::string& error);

/// Read the strands of a recipe, and the strand_uvs() of their map. False, with the reason in `error`, as
/// read_strand_file().
bool read_strand_uvs(Strands& dst, std::vector<Imath::V2f>& uvs, const VismapRecipe& recipe, std::string& error);

/// What is known of a scene once it is built.
struct StrandSceneFacts
{
    std::string occluder_hashes; ///< mesh_hash() of each occluder, separated by commas
    std::string occluder_names; ///< Mesh::name of each, separated by ", "
    std::vector<std::string> warnings; ///< of the occluders' files
    std::vector<FileStamp> files; ///< that were read
};

/// Read the occluders of a recipe and build the scene of its strands. False as read_strand_file().
bool build_strand_scene(StrandScene& dst, StrandSceneFacts& facts, const Strands& strands, const VismapRecipe& recipe,
                        const SceneStamps& stamps, const MakeOptions& options, std::string& at, std::string& error);

} // namespace vmlight
