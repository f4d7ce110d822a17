// SPDX-License-Identifier: Apache-2.0
#include "light_input.h"

#include <vmlight/channels.h>
#include <vmlight/image_file.h>

#include <OpenImageIO/strutil.h>

namespace vmlight {

using OIIO::Strutil::fmt::format;

void LightInput::declare(StageMain& stage)
{
    stage.group("Surface:");
    stage.option("albedo", "IMAGE", "Multiply by this texture, converted to scene-linear", m_albedo_path);
    stage.option("albedo_colorspace", "NAME", "Its colour space, if its name and tags do not tell", m_albedo_space);
    stage.params("Filter, if an environment is given:", m_filter, "cfem_");
    stage.group("Colour:");
    stage.option("is_cfem", "", "The second image is filtered already, though nothing in it says so",
                 [this](OIIO::string_view, std::string&) { return m_is_cfem = true; });
    stage.option("colorspace", "NAME", "Colour space of the environment, if its name and tags do not tell",
                 m_color.from);
    stage.option("colorconfig", "FILE", "OCIO config; without it $OCIO", m_color.config);
}

bool LightInput::read(StageMain& stage, std::string& error)
{
    if (!read_image(vismap, stage.operand(0), error))
        return false;
    // Before the environment is filtered in vain.
    std::array<int, 4> channels;
    if (!find_vismap_channels(vismap.spec(), channels, error)) {
        error = format("\"{}\": {}", stage.operand(0), error);
        return false;
    }
    if (!read_image(cfem, stage.operand(1), error))
        return false;
    const std::string kind = cfem.spec().get_string_attribute("vmlight:stage");
    if (kind == kVismapStage || kind == kLightmapStage) {
        error
            = format("\"{}\": neither an environment nor a CFEM: its vmlight:stage is \"{}\"", stage.operand(1), kind);
        return false;
    }
    if (!m_is_cfem && kind != kCfemStage && !filter(stage, error))
        return false;
    if (m_albedo_path.empty())
        return true;
    std::string note;
    if (!read_image(m_albedo, m_albedo_path, error)
        || !to_scene_linear(m_albedo, m_albedo_path, { m_color.config, m_albedo_space }, note, error))
        return false;
    stage.say("albedo: " + note);
    return true;
}

bool LightInput::filter(StageMain& stage, std::string& error)
{
    std::string note;
    OIIO::ImageBuf filtered;
    if (!to_scene_linear(cfem, stage.operand(1), m_color, note, error))
        return false;
    if (!make_cfem(filtered, cfem, m_filter, stage.threads(), stage.progress("filter"))) {
        error = format("\"{}\": {}", stage.operand(1), filtered.geterror());
        return false;
    }
    stage.say("colour: " + note);
    cfem = std::move(filtered);
    return true;
}

} // namespace vmlight
