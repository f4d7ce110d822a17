// SPDX-License-Identifier: Apache-2.0
#include "display_config.h"

#include <vmlight/base/format.h>

#include <OpenImageIO/strutil.h>
#include <OpenImageIO/sysutil.h>

#include <algorithm>
#include <sstream>

namespace vmlight::view {

namespace OCIO = OCIO_NAMESPACE;

namespace {

// Where there is no config, light is linear Rec.709 (image/color.h), and screens show sRGB.
constexpr const char* kPlainConfig = R"(ocio_profile_version: 2
roles: {scene_linear: lin_rec709_scene, default: lin_rec709_scene}
file_rules: [!<Rule> {name: Default, colorspace: default}]
displays:
  sRGB:
    - !<View> {name: Standard, colorspace: srgb_rec709_scene}
    - !<View> {name: Raw, colorspace: lin_rec709_scene}
colorspaces:
  - !<ColorSpace> {name: lin_rec709_scene}
  - !<ColorSpace>
    name: srgb_rec709_scene
    from_scene_reference: !<ExponentWithLinearTransform> {gamma: 2.4, offset: 0.055, direction: inverse}
)";

bool fail_unless_known(const char* what, const std::string& word, const std::vector<std::string>& known,
                       std::string& error)
{
    if (std::find(known.begin(), known.end(), word) != known.end())
        return true;
    error = format("the OCIO config has no {} \"{}\"; it has \"{}\"", what, word, OIIO::Strutil::join(known, "\", \""));
    return false;
}

} // namespace

bool DisplayConfig::open(const std::string& path, std::string& error)
{
    const std::string file = path.empty() ? std::string(OIIO::Sysutil::getenv("OCIO")) : path;
    try {
        std::istringstream plain(kPlainConfig);
        m_config = file.empty() ? OCIO::Config::CreateFromStream(plain) : OCIO::Config::CreateFromFile(file.c_str());
    } catch (const OCIO::Exception& exception) {
        error = format("\"{}\": not an OCIO config: {}", file, exception.what());
        return false;
    }
    if (displays().empty())
        error = format("\"{}\": the OCIO config has no display", file);
    else if (!m_config->getColorSpace(OCIO::ROLE_SCENE_LINEAR))
        error = format("\"{}\": the OCIO config has no role scene_linear", file);
    return error.empty();
}

std::vector<std::string> DisplayConfig::displays() const
{
    std::vector<std::string> names;
    for (int i = 0; i < m_config->getNumDisplays(); ++i)
        names.emplace_back(m_config->getDisplay(i));
    return names;
}

std::vector<std::string> DisplayConfig::views(const std::string& display) const
{
    std::vector<std::string> names;
    for (int i = 0; i < m_config->getNumViews(display.c_str()); ++i)
        names.emplace_back(m_config->getView(display.c_str(), i));
    return names;
}

std::vector<std::string> DisplayConfig::looks() const
{
    std::vector<std::string> names;
    for (int i = 0; i < m_config->getNumLooks(); ++i)
        names.emplace_back(m_config->getLookNameByIndex(i));
    return names;
}

bool DisplayConfig::settle(DisplayChoice& choice, std::string& error) const
{
    if (choice.display.empty())
        choice.display = m_config->getDefaultDisplay();
    if (!fail_unless_known("display", choice.display, displays(), error))
        return false;
    if (choice.view.empty())
        choice.view = m_config->getDefaultView(choice.display.c_str());
    return fail_unless_known("view", choice.view, views(choice.display), error)
        && (choice.look.empty() || fail_unless_known("look", choice.look, looks(), error));
}

OCIO::ConstProcessorRcPtr DisplayConfig::no_change() const
{
    return m_config->getProcessor(OCIO::MatrixTransform::Create());
}

OCIO::ConstProcessorRcPtr DisplayConfig::processor(const DisplayChoice& choice, std::string& error) const
{
    try {
        const auto transform = OCIO::DisplayViewTransform::Create();
        transform->setSrc(OCIO::ROLE_SCENE_LINEAR);
        transform->setDisplay(choice.display.c_str());
        transform->setView(choice.view.c_str());
        const auto pipeline = OCIO::LegacyViewingPipeline::Create();
        pipeline->setDisplayViewTransform(transform);
        pipeline->setLooksOverrideEnabled(!choice.look.empty());
        pipeline->setLooksOverride(choice.look.c_str());
        return pipeline->getProcessor(m_config);
    } catch (const OCIO::Exception& exception) {
        error = format("display \"{}\", view \"{}\": {}", choice.display, choice.view, exception.what());
        return nullptr;
    }
}

} // namespace vmlight::view
