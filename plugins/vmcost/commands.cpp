// SPDX-License-Identifier: Apache-2.0
#include "commands.h"

#include "models.h"

#include <vmlight/base/format.h>
#include <vmlight/cli/command_line.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cctype>

namespace vmlight::cost {
namespace {

std::string quoted(const std::string& text)
{
    const auto is_plain = [](unsigned char c) {
        return std::isalnum(c) || std::string("_-+=./,:@%").find(char(c)) != std::string::npos;
    };
    return !text.empty() && std::all_of(text.begin(), text.end(), is_plain)
        ? text
        : "'" + OIIO::Strutil::replace(text, "'", "'\\''", true) + "'";
}

std::string flag(const std::string& name, const std::string& value)
{
    return value.empty() ? "" : format(" {} {}", flag_of(name), quoted(value));
}

// The flags of what differs from the defaults.
template <class Params> std::string flags(Params params, const std::string& prefix = "")
{
    std::vector<std::string> defaults;
    Params().visit([&](const char*, auto& value, const auto& allowed, const char*) {
        defaults.push_back(value_text(value, allowed));
    });
    std::string text;
    size_t i = 0;
    params.visit([&](const char* name, auto& value, const auto& allowed, const char*) {
        const std::string now = value_text(value, allowed);
        if (now == defaults[i++])
            return;
        const bool is_flag = allowed_text(allowed).empty();
        text += is_flag ? " " + flag_of(prefix + name) : flag(prefix + name, now);
    });
    return text;
}

std::string stem(const std::string& path)
{
    const std::string file = OIIO::Filesystem::filename(path);
    return file.substr(0, file.size() - OIIO::Filesystem::extension(file).size());
}

} // namespace

std::string command_text(const Setting& setting, const CommandInputs& inputs)
{
    const ModelVariant* variant = find_variant(setting.model);
    if (!variant)
        return "";
    VismapParams map = inputs.mesh.vismap_params;
    map.samples = setting.samples;
    map.resolution = { map.resolution.width / setting.divisor, map.resolution.height / setting.divisor };
    variant->set_bake(map);
    CfemParams filter;
    filter.resolution = { setting.cfem_width, setting.cfem_width / 2 };
    filter.sanitize = inputs.sanitize;
    LightmapParams light;
    light.model = variant->model->name;

    const std::string name = stem(inputs.mesh.mesh), vismap = name + "_vismap.exr";
    std::string bake = "makevismap " + quoted(inputs.mesh.mesh) + flags(inputs.mesh.mesh_params)
        + flags(inputs.mesh.cutout_params) + flags(map);
    for (const std::string& occluder : inputs.mesh.occluder)
        bake += flag("occluder", occluder);
    for (const std::string& material : inputs.mesh.selection.material)
        bake += flag("material", material);
    for (const std::string& node : inputs.mesh.selection.node)
        bake += flag("node", node);
    if (setting.storage == "half")
        bake += flag("format", setting.storage);
    const CfemRecipe& given = inputs.light;
    const std::string reading = flag("colorspace", given.colorspace) + flag("colorconfig", given.colorconfig)
        + flag("layer", given.layer) + flag("layout", given.layout == CfemRecipe().layout ? "" : given.layout);
    std::string suns = variant->suns ? " --suns auto" + flag("mesh", inputs.mesh.mesh) : "";
    for (const std::string& occluder : inputs.mesh.occluder)
        suns += variant->suns ? flag("occluder", occluder) : "";
    return format("{} -o {} && makelightmap {} {}{}{}{}{} -o {}", bake, quoted(vismap), quoted(vismap),
                  quoted(inputs.environment), flags(light), suns, flags(filter, "cfem_"), reading,
                  quoted(format("{}_{}.exr", name, stem(inputs.environment))));
}

} // namespace vmlight::cost
