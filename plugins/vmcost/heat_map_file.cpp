// SPDX-License-Identifier: Apache-2.0
#include "heat_map_file.h"

#include "heat_map.h"
#include "named_channels.h"

#include <vmlight/base/interrupt.h>
#include <vmlight/base/output_file.h>
#include <vmlight/image/image_file.h>

#include <OpenImageIO/filesystem.h>

namespace vmlight::cost {
namespace {

constexpr const char* kKey = "vmlight:costKey";

} // namespace

std::string heat_map_path(const std::string& folder, const std::string& environment, const std::string& model)
{
    return folder + "/error_" + environment + "_" + model;
}

bool has_heat_map(const std::string& folder, const std::string& environment, const std::string& model,
                  const std::string& key)
{
    const std::string path = heat_map_path(folder, environment, model);
    OIIO::ImageBuf map;
    std::string ignored; // it will be made
    return OIIO::Filesystem::exists(path + ".png") && read_channels(map, path + ".exr", kHeatMapChannels, ignored)
        && map.spec().get_string_attribute(kKey) == key;
}

bool write_heat_map(const std::string& folder, const std::string& environment, const std::string& model,
                    const std::string& key, const OIIO::ImageBuf& lightmap, const OIIO::ImageBuf& reference,
                    std::string& error)
{
    OIIO::ImageBuf map = heat_map(lightmap, reference);
    map.specmod().attribute(kKey, key);
    const std::string path = heat_map_path(folder, environment, model);
    std::string png;
    const DeferInterrupts writing;
    // The EXR last: its presence means that both are complete.
    return heat_map_png(png, map, 0, error) && write_file(path + ".png", png, error)
        && write_image(map, path + ".exr", {}, {}, error);
}

} // namespace vmlight::cost
