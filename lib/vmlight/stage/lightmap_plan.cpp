// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/lightmap_plan.h>

#include <vmlight/base/format.h>
#include <vmlight/base/tile_size.h>
#include <vmlight/cfem/stack.h>
#include <vmlight/image/channels.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/lightmap/shader.h>
#include <vmlight/lightmap/vismap_check.h>
#include <vmlight/stage/bake_switches.h>
#include <vmlight/stage/bounce_shading.h>
#include <vmlight/stage/light_effects.h>
#include <vmlight/stage/recipe/udim.h>
#include <vmlight/stage/sun_choice.h>

#include <OpenImageIO/filesystem.h>

#include <algorithm>

namespace vmlight {

LightmapPlan::LightmapPlan(const LightmapRecipe& given, LightmapImages images)
    : m_given(given)
    , m_recipe(with_switches(given))
    , m_images(std::move(images))
{
}

bool LightmapPlan::settle(const RecipeChain& chain, std::string& error)
{
    const OIIO::ImageSpec& vismap = m_images.vismap->spec();
    // A stack, or its last image stored on its own.
    const bool has_all
        = m_images.cfem->subimages() > 1 || m_images.cfem->spec().get_float_attribute("vmlight:lobe") == 1;
    if (!choose_model(m_model, m_recipe.lightmap_params, vismap, has_all, error)
        || !find_vismap_channels(vismap, m_vismap_channels, error))
        error = with_location(m_recipe, "vismap", chain, format("\"{}\": {}", m_recipe.vismap, error));
    else if (const std::string fault = kernel_fault(m_model, vismap, m_images.cfem->spec()); !fault.empty())
        error = with_location(m_recipe, "cfem", chain, format("\"{}\": {}", m_recipe.cfem, fault));
    Rotation rotation;
    if (!error.empty())
        return false;
    if (!lightmap_rotation(rotation, m_recipe.lightmap_params, error)) {
        error = chain.empty() ? error : format("\"{}\": {}", chain.back(), error);
        return false;
    }
    for (const std::string& channel : m_model.channels)
        m_channels.push_back(vismap.channelindex(channel));
    m_spec = describe_lightmap(vismap, m_images.light.spec, m_recipe.lightmap_params, m_model.name);
    if (!m_output.open(m_recipe.output_colorspace, m_recipe.colorconfig, m_spec, error)) {
        error = with_location(m_recipe, "output_colorspace", chain, error);
        return false;
    }
    if (m_images.suns) // which the light has, as far as a header can know
        m_spec.attribute("vmlight:model", with_suns(m_model.name));
    if (m_images.bounce)
        m_images.bounce->tag(m_spec);
    tag_no_suns(m_spec, no_suns_text());
    m_output.tag(m_spec);
    tag_effects(m_spec, switched_off(m_given.effects, LightmapRecipe::kStage));
    tag_udim(m_spec, m_recipe.udim);
    m_spec.tile_width = m_spec.tile_height = kTileSize;
    m_spec.tile_depth = 1;
    return true;
}

std::string LightmapPlan::no_suns_text() const
{
    return m_images.no_suns.empty()
        ? ""
        : why_no_suns(m_recipe, m_images.vismap->spec(), OIIO::Filesystem::filename(m_recipe.vismap));
}

ImageRange LightmapPlan::images_of_use() const
{
    const int images = m_images.cfem->subimages();
    return m_model.light == ModelLight::radiance ? ImageRange { images - 1, 1 }
        : m_model.light == ModelLight::lobes     ? ImageRange { 0, std::min(images, kStackLevels) }
                                                 : ImageRange {};
}

void tag_no_suns(OIIO::ImageSpec& lightmap, const std::string& text)
{
    if (!text.empty())
        lightmap.attribute("vmlight:no_suns", text);
}

void tag_effects(OIIO::ImageSpec& lightmap, const std::string& off)
{
    if (!off.empty())
        lightmap.attribute(metadata_name("effects"), off);
}

} // namespace vmlight
