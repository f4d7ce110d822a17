// SPDX-License-Identifier: Apache-2.0
/// What a recipe of a lightmap asks for, as far as it is known before any pixel is read.
#pragma once

#include <vmlight/lightmap/model.h>
#include <vmlight/stage/lightmap_images.h>
#include <vmlight/stage/output_color.h>
#include <vmlight/stage/pixel_source.h>
#include <vmlight/stage/recipe/recipe.h>

#include <array>
#include <string>
#include <vector>

namespace vmlight {

class LightmapPlan
{
public:
    /// @param given    resolved to one UDIM tile, and without faults
    LightmapPlan(const LightmapRecipe& given, LightmapImages images);

    /// Choose the model, and describe the lightmap. False, with the reason in `error`, if the map or the light do not
    /// fit the recipe.
    bool settle(const RecipeChain& chain, std::string& error);

    const LightmapRecipe& given() const { return m_given; }
    /// With its switches applied.
    const LightmapRecipe& recipe() const { return m_recipe; }
    const LightmapImages& images() const { return m_images; }
    const ShadingModel& model() const { return m_model; }
    /// The map's channels that the model reads, and those of V and B.
    const std::vector<int>& channels() const { return m_channels; }
    const std::array<int, 4>& vismap_channels() const { return m_vismap_channels; }
    const OutputColor& output() const { return m_output; }
    const OIIO::ImageSpec& spec() const { return m_spec; }

    /// The images of a stack that the model reads.
    ImageRange images_of_use() const;
    /// Why suns that were asked for stay in the environment, without folders; or "". A reader cannot warn.
    std::string no_suns_text() const;

private:
    const LightmapRecipe m_given, m_recipe;
    const LightmapImages m_images;
    ShadingModel m_model;
    std::vector<int> m_channels;
    std::array<int, 4> m_vismap_channels {};
    OutputColor m_output;
    OIIO::ImageSpec m_spec;
};

/// Metadata of a lightmap; nothing if the text is "".
void tag_no_suns(OIIO::ImageSpec& lightmap, const std::string& text);
void tag_effects(OIIO::ImageSpec& lightmap, const std::string& off);

} // namespace vmlight
