// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/whole_light.h>

#include <vmlight/base/format.h>
#include <vmlight/stage/open_source.h>
#include <vmlight/stage/stored_image.h>
#include <vmlight/stage/sun_source.h>

#include <algorithm>
#include <array>

namespace vmlight {

bool find_suns(std::vector<Sun>& dst, const LightmapRecipe& recipe, const LightmapImages& images, std::string& error)
{
    dst.clear();
    if (!images.suns)
        return true;
    std::string text;
    if (!find_suns(text, *images.cfem, error) || !parse_suns(dst, text, error)) {
        error = format("\"{}\": {}", recipe.cfem.empty() ? recipe.environment : recipe.cfem, error);
        return false;
    }
    for (Sun& sun : dst)
        if (images.light.conversion) {
            std::array<float, 3> rgb;
            std::copy(sun.color.begin(), sun.color.end(), rgb.begin());
            images.light.conversion(rgb.data(), 1);
            std::copy(rgb.begin(), rgb.end(), sun.color.begin());
        }
    return true;
}

const OIIO::ImageBuf* WholeLight::map(std::string& error)
{
    return m_map.initialized() || read_all(m_map, *m_images.vismap, error) ? &m_map : nullptr;
}

bool WholeLight::add_suns(LightmapShader& dst, std::string& error)
{
    if (!m_images.suns)
        return true;
    std::vector<Sun> suns;
    if (!find_suns(suns, m_recipe, m_images, error))
        return false;
    const auto read = [&](int channel, std::vector<float>& plane, std::string& reason) {
        const OIIO::ImageBuf* whole = map(reason);
        if (!whole)
            return false;
        const auto* texel = static_cast<const float*>(whole->localpixels());
        plane.resize(size_t(whole->spec().image_pixels()));
        for (size_t i = 0; i < plane.size(); ++i)
            plane[i] = texel[i * size_t(whole->nchannels()) + size_t(channel)];
        return true;
    };
    auto light = std::make_shared<SunLight>();
    if (!m_images.suns->light(*light, suns, m_recipe.lightmap_params, read, {}, error))
        return false;
    m_bytes += sizeof(float) * light->visibility.size() + m_images.suns->bytes();
    m_suns = light;
    dst.use_suns(light);
    return true;
}

bool WholeLight::add_bounce(LightmapShader& dst, const std::vector<OIIO::ImageBuf>& cfem, const AlbedoReader* albedo,
                            std::string& error)
{
    if (!m_images.bounce)
        return true;
    const OIIO::ImageBuf* whole = map(error);
    auto light = std::make_shared<BounceLight>();
    // With suns, even if there are none: their light was looked for, and the CFEM says so.
    if (!whole
        || !m_images.bounce->light(*light, *whole, cfem, m_suns.get(), m_recipe.lightmap_params, *albedo, {}, error))
        return false;
    m_bytes += sizeof(float) * light->light.size() + m_images.bounce->bytes();
    if (!light->light.empty())
        dst.use_bounce(light);
    return true;
}

} // namespace vmlight
