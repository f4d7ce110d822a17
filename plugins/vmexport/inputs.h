// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "request.h"

#include <vmlight/mesh/mesh.h>
#include <vmlight/stage/make_options.h>

#include <OpenImageIO/imagebuf.h>

#include <memory>
#include <string>
#include <vector>

namespace vmlight::exporting {

/// One tile of a visibility map.
struct MapTile
{
    std::string path;
    int udim;
    /// Whether the file's name has the tile's number.
    bool is_numbered;
};

/// The tiles that the operand names. False, with the reason in `error`, if `<UDIM>` stands for no file.
bool find_tiles(std::vector<MapTile>& dst, const std::string& vismap, std::string& error);

/// Read or make a visibility map, whole. Warns of one that was not weighted by the cosine, as all engines ask.
bool read_map(OIIO::ImageBuf& dst, const std::string& path, const MakeOptions& options, std::string& error);

/// Read a lightmap as engine_light(). Warns if it was lit by a map of another mesh than `map` is of.
/// @returns false, with the reason in `error`, if it cannot be read or is another kind of image
bool read_lightmap(OIIO::ImageBuf& dst, const std::string& path, const OIIO::ImageSpec& map, const MakeOptions& options,
                   std::string& error);

/// Read the mesh as the metadata of the map say: with the same UVs, up axis, normals and selection. Warns if it is not
/// the one that was baked.
bool read_map_mesh(std::shared_ptr<const Mesh>& dst, const std::string& path, const OIIO::ImageSpec& map,
                   const MakeOptions& options, std::string& error);

} // namespace vmlight::exporting
