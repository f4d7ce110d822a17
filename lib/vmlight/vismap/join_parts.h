// SPDX-License-Identifier: Apache-2.0
/// Joins the parts of a map that bake_parts() made.
#pragma once

#include <vmlight/vismap/map_rows.h>

#include <OpenImageIO/imagebuf.h>

#include <cstdint>
#include <functional>
#include <string>

namespace vmlight {

struct JoinReport
{
    int64_t covered = 0; ///< texels
    int64_t dark = 0; ///< of them, with V below 0.01
    double margin_seconds = 0;
};

/// Sets `part` to part number `index` of a map, as float. Returns false, with the reason in `error`, on failure.
using ReadPart = std::function<bool(OIIO::ImageBuf& part, int index, std::string& error)>;

/// Join the parts of a map: copy their tiles, then fill the margin. Traces no ray. One part is in memory at a time, and
/// the rows of the map that its margin still needs.
///
/// @param rows     receives the map: the pixels and metadata of make_vismap()
/// @param count    parts of the map
/// @param read     called for each of them, in their order
/// @returns false, with the reason in `error`, if a part cannot be read, is damaged or does not fit those before, if
///          memory runs out, or if `rows` returned it
bool join_parts(const MapRows& rows, int count, const ReadPart& read, JoinReport& report, std::string& error);

} // namespace vmlight
