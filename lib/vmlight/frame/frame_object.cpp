// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/frame_object.h>

#include <vmlight/base/format.h>
#include <vmlight/frame/lit_object.h>
#include <vmlight/frame/lit_strands.h>
#include <vmlight/image/channels.h>
#include <vmlight/lightmap/model.h>
#include <vmlight/stage/recipe/strand_recipe.h>

#include <array>
#include <utility>

namespace vmlight {
namespace {

// `auto` has the best that a small map can hold.
constexpr const char* kAutoBasis = "sh";

// The channels of `names`, texel by texel.
std::vector<float> gathered(const OIIO::ImageBuf& image, OIIO::cspan<int> index)
{
    const OIIO::ImageSpec& spec = image.spec();
    const auto* pixels = static_cast<const float*>(image.localpixels());
    const size_t count = size_t(spec.width) * size_t(spec.height), channels = size_t(spec.nchannels);
    std::vector<float> result(count * index.size());
    for (size_t i = 0; i < count; ++i)
        for (size_t c = 0; c < size_t(index.size()); ++c)
            result[i * size_t(index.size()) + c] = pixels[i * channels + size_t(index[c])];
    return result;
}

} // namespace

std::string basis_for(const std::string& model, const std::string& asked)
{
    if (asked != "vector")
        return asked;
    if (model == "auto")
        return kAutoBasis;
    const ModelEntry* entry = find_model_entry(model);
    return entry && *entry->basis ? entry->basis : asked;
}

bool FrameObject::show_texture(const std::string& name, const MakeOptions& options, std::string& error)
{
    auto texture = std::make_shared<FileTexture>();
    if (!texture->open(name, error))
        return false;
    if (texture->has_integers() && !std::exchange(m_warned_of_texture, true))
        options.report_warning(format("\"{}\": has integer pixels, as albedo textures do; shown as light, and no "
                                      "environment changes it. The colour of an object comes from its materials",
                                      name));
    m_surface.light = std::move(texture);
    return true;
}

TexturePyramid FrameObject::pyramid(int udim, const OIIO::ImageBuf& map, int channels, const float* pixels,
                                    int nthreads)
{
    const std::vector<float>& covered = weights(udim, map, nthreads);
    return TexturePyramid(map.spec().width, map.spec().height, channels, pixels,
                          covered.empty() ? nullptr : covered.data(), TextureWrap::clamp, TextureWrap::clamp, nthreads);
}

bool FrameObject::show_light(int udim, const OIIO::ImageBuf& lightmap, int nthreads, std::string& error)
{
    std::array<int, 3> index;
    if (!find_color_channels(lightmap.spec(), index, error))
        return false;
    if (!m_light)
        m_surface.light = m_light = std::make_shared<TileTexture>(3);
    const float* pixels = static_cast<const float*>(lightmap.localpixels());
    std::vector<float> copy;
    if (lightmap.nchannels() != 3) {
        copy = gathered(lightmap, index);
        pixels = copy.data();
    }
    m_light->set(udim, pyramid(udim, lightmap, 3, pixels, nthreads));
    return true;
}

void FrameObject::show_visibility(int nthreads)
{
    if (m_maps.empty())
        return;
    auto texture = std::make_shared<TileTexture>(4);
    for (const auto& [udim, map] : m_maps[m_basis]) {
        std::array<int, 4> index;
        std::string ignored; // light() has refused what is no map
        if (!find_vismap_channels(map.spec(), index, ignored))
            continue;
        texture->set(udim, pyramid(udim, map, 4, gathered(map, index).data(), nthreads));
    }
    m_surface.visibility = std::move(texture);
}

std::unique_ptr<FrameObject> make_frame_object(const ObjectRecipe& recipe)
{
    if (is_strand_occluder(recipe.map, recipe.map.mesh))
        return std::make_unique<LitStrands>();
    return std::make_unique<LitObject>();
}

} // namespace vmlight
