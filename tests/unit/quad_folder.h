// SPDX-License-Identifier: Apache-2.0
/// Files of small scenes of quads that light each other.
#pragma once

#include "stage_scene.h"

#include <vmlight/stage/make_stage.h>

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

namespace vmlight::stage_scene {

/// Scenes of quads, 32x32 texels each, under a sky of 1 and with albedos of 1, unless a test writes others.
class QuadFolder : public Folder
{
public:
    QuadFolder()
    {
        image("sky.exr", 8, 4, [](int, int) { return 1.0f; });
        image("white.exr", 32, 32, [](int, int) { return 1.0f; });
    }
    void image(const std::string& name, int width, int height, const std::function<float(int x, int y)>& at) const
    {
        OIIO::ImageBuf image(OIIO::ImageSpec(width, height, 3, OIIO::TypeFloat));
        for (OIIO::ImageBuf::Iterator<float> pixel(image); !pixel.done(); ++pixel) {
            const float grey = at(pixel.x(), pixel.y());
            pixel[0] = grey, pixel[1] = grey, pixel[2] = grey;
        }
        EXPECT_TRUE(image.write(*this / name)) << image.geterror();
    }
    LightmapRecipe recipe(const std::string& map) const
    {
        LightmapRecipe recipe;
        write("map.vismap", "resolution = 32\nmargin = 0\nsamples = 256\n" + map);
        recipe.vismap = *this / "map.vismap";
        recipe.environment = *this / "sky.exr";
        recipe.albedo = *this / "white.exr";
        recipe.bounce_params.bounce = "auto";
        return recipe;
    }
    static std::vector<float> lit(const LightmapRecipe& recipe)
    {
        OIIO::ImageBuf image;
        EXPECT_TRUE(make_image(image, recipe)) << image.geterror();
        return image.initialized() ? all_pixels(image) : std::vector<float>(3 * 32 * 32);
    }
    // What the bounce adds.
    static std::vector<float> bounced(const LightmapRecipe& recipe)
    {
        LightmapRecipe direct = recipe;
        direct.bounce_params = {};
        std::vector<float> all = lit(recipe);
        const std::vector<float> of_sky = lit(direct);
        for (size_t i = 0; i < all.size(); ++i)
            all[i] -= of_sky[i];
        return all;
    }
    static double mean(const std::vector<float>& values)
    {
        double sum = 0;
        for (const float value : values)
            sum += double(value) / double(values.size());
        return sum;
    }
};

} // namespace vmlight::stage_scene
