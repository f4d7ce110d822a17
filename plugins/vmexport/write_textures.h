// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "request.h"

#include <vmlight/stage/make_options.h>

#include <string>

namespace vmlight::exporting {

/// Write all files that are asked for, each atomically, and say how each is decoded. Nothing of a tile is written
/// before all of it is encoded. False, with the reason in `error`, if an input cannot be read or used, or a file cannot
/// be written; files that were written before stay.
bool write_textures(const Request& request, const MakeOptions& options, std::string& error);

} // namespace vmlight::exporting
