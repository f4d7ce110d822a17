// SPDX-License-Identifier: Apache-2.0
/// Visibility maps that are written while they are baked, from the top down, because as a whole they would take much
/// memory. The same file as of a map that is baked whole.
#pragma once

#include <vmlight/image/exr_output.h>
#include <vmlight/image/image_file.h>
#include <vmlight/stage/make_options.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/vismap/map_rows.h>

#include <string>

namespace vmlight {

/// Whether a map is written while it is baked: as a whole it would take more than a gigabyte, it is of a mesh, its
/// margin reaches no farther than two tiles, and it is not one of several poses, which keep texels of each other.
bool is_large_map(const VismapRecipe& recipe, const MakeOptions& options);

/// The file of a map that passes from the top down. Errors name its path, which is unchanged unless commit() succeeds.
class MapFile
{
public:
    MapFile(const std::string& path, const FileParams& params);

    /// For one map: writes what it receives. `progress` is called with 0, and stops it by returning false.
    MapRows rows(const Progress& progress = {});
    bool commit(std::string& error) { return m_output.commit(error); }

private:
    const std::string m_path;
    const FileParams m_params;
    ExrOutput m_output;
};

/// Bytes that a bake of `recipe` holds of its map: the whole of it and what reconstruction needs, or some rows of tiles
/// if it is written while it is baked.
double map_bytes(const VismapRecipe& recipe, const MakeOptions& options);

/// Bake a visibility map and write it to `path` row by row. False, with the reason in `error`, as make_image() and
/// write_image(): the file is then unchanged.
bool write_large_map(const VismapRecipe& recipe, const std::string& path, const FileParams& file,
                     const MakeOptions& options, std::string& error);

/// Bake a visibility map from the top down. False, with the reason in `error`, as make_image(), or if `rows` returned
/// it.
bool stream_vismap(const MapRows& rows, const VismapRecipe& recipe, const MakeOptions& options, std::string& error);

} // namespace vmlight
