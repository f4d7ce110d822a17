// SPDX-License-Identifier: Apache-2.0
/// Light that a reader of a lightmap traces whole, before its first tile: that of suns, whose tiles share rays and
/// margins, and bounced light, which each texel gets from anywhere.
#pragma once

#include <vmlight/lightmap/shader.h>
#include <vmlight/stage/lightmap_images.h>
#include <vmlight/stage/recipe/recipe.h>

#include <OpenImageIO/imagebuf.h>

#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// Set `dst` to the suns that were split off the light of `images`, in its colour space; none if the recipe's suns are
/// off. False, with the reason in `error`, if they cannot be found.
bool find_suns(std::vector<Sun>& dst, const LightmapRecipe& recipe, const LightmapImages& images, std::string& error);

/// What a shader needs of the whole map before it lights a tile.
class WholeLight
{
public:
    /// @param recipe, images   of the lightmap; must outlive this
    WholeLight(const LightmapRecipe& recipe, const LightmapImages& images)
        : m_recipe(recipe)
        , m_images(images)
    {
    }

    /// Let `dst` add the light of the suns, if the recipe has them. Before its prepare(). False, with the reason in
    /// `error`, as SunShading::light().
    bool add_suns(LightmapShader& dst, std::string& error);
    /// Let `dst` add bounced light, if the recipe has it and any texel gets some. After add_suns(). False, with the
    /// reason in `error`, as BounceShading::light().
    ///
    /// @param cfem     the images of the light that the model reads
    /// @param albedo   opened for the pixels of the map; nullptr without a bounce
    bool add_bounce(LightmapShader& dst, const std::vector<OIIO::ImageBuf>& cfem, const AlbedoReader* albedo,
                    std::string& error);

    /// What was given to the shader, and what further rotations would start from.
    size_t bytes() const { return m_bytes; }

private:
    const OIIO::ImageBuf* map(std::string& error);

    const LightmapRecipe& m_recipe;
    const LightmapImages& m_images;
    OIIO::ImageBuf m_map; // the visibility map, once it is read
    std::shared_ptr<const SunLight> m_suns;
    size_t m_bytes = 0;
};

} // namespace vmlight
