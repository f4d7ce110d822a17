// SPDX-License-Identifier: Apache-2.0
/// Visibility maps that are baked in parts, and joined: parts on different machines, or in a bake that can be resumed.
#pragma once

#include <vmlight/stage/make_options.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/vismap/join_parts.h>

#include <OpenImageIO/imagebuf.h>

#include <functional>
#include <string>
#include <vector>

namespace vmlight {

/// Which parts of a map to bake, see PartsJob.
struct PartRequest
{
    int count = 1;
    std::vector<int> parts;
    std::function<bool(int part, const OIIO::ImageSpec& spec)> is_made;
    std::function<bool(int part, const OIIO::ImageBuf& image, std::string& error)> write;
};

/// Bake parts of a map. False, with the reason in `error`, as make_image(); parts that were written stay.
bool make_vismap_parts(const VismapRecipe& recipe, const PartRequest& request, const MakeOptions& options,
                       std::string& error);

/// Whether the file `path` holds, whole, the part that `spec` describes.
bool is_whole_part(const std::string& path, const OIIO::ImageSpec& spec);

/// The files of the parts of one map.
struct PartFiles
{
    std::string material, node; ///< "" if the map is not of one material or node
    int udim = 0;
    std::vector<std::string> paths; ///< by the parts' numbers
};

/// Sort files into those of each map, by their headers: UDIM tiles, materials and nodes have a map each.
///
/// @returns false, with the reason in `error`, if a file cannot be read or is no part, if a part is given twice, is of
///          another map than the others or does not fit them, or if parts are missing, which it names
bool sort_parts(std::vector<PartFiles>& dst, const std::vector<std::string>& paths, std::string& error);

/// Join the parts of a map. False, with the reason and the file in `error`, as join_parts().
bool join_files(const MapRows& rows, const std::vector<std::string>& paths, JoinReport& report, std::string& error);

} // namespace vmlight
