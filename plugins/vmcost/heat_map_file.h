// SPDX-License-Identifier: Apache-2.0
/// Heat map files of a report.
#pragma once

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight::cost {

/// "FOLDER/error_ENVIRONMENT_MODEL", without extension.
std::string heat_map_path(const std::string& folder, const std::string& environment, const std::string& model);

/// Whether there is a readable heat map for the row with this key.
bool has_heat_map(const std::string& folder, const std::string& environment, const std::string& model,
                  const std::string& key);

/// Write the errors as EXR, with the row's key in `vmlight:costKey`, and in false colour as PNG. Returns false, with
/// the reason in `error`.
bool write_heat_map(const std::string& folder, const std::string& environment, const std::string& model,
                    const std::string& key, const OIIO::ImageBuf& lightmap, const OIIO::ImageBuf& reference,
                    std::string& error);

} // namespace vmlight::cost
