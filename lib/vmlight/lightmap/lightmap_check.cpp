// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/lightmap_check.h>

#include <vmlight/base/format.h>
#include <vmlight/image/channels.h>

namespace vmlight {

std::string lightmap_fault(const OIIO::ImageSpec& spec)
{
    const std::string stage = spec.get_string_attribute("vmlight:stage");
    return stage.empty() || stage == kLightmapStage
        ? ""
        : format("not a lightmap: its vmlight:stage is \"{}\", not \"{}\"", stage, kLightmapStage);
}

std::string other_mesh_warning(const OIIO::ImageSpec& lightmap, const OIIO::ImageSpec& vismap)
{
    const auto of
        = [](const OIIO::ImageSpec& spec, const char* name) { return std::string(spec.get_string_attribute(name)); };
    const std::string lit = of(lightmap, "vmlight:meshHash"), baked = of(vismap, "vmlight:meshHash");
    return lit.empty() || baked.empty() || lit == baked
        ? ""
        : format("lights the mesh \"{}\", and the visibility map is of another, \"{}\"", of(lightmap, "vmlight:mesh"),
                 of(vismap, "vmlight:mesh"));
}

} // namespace vmlight
