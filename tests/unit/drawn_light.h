// SPDX-License-Identifier: Apache-2.0
/// Light drawn at random: environments, rotations and albedos, with those that change nothing among them.
#pragma once

#include "drawn_scene.h"

#include <vmlight/cfem/cfem.h>
#include <vmlight/lightmap/lightmap.h>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <array>
#include <limits>
#include <random>
#include <string>

namespace vmlight {

/// What a seed draws for the map of `scene`. Parts can be taken away.
struct DrawnLight
{
    OIIO::ImageBuf environment, albedo; ///< albedo: not initialized: none
    bool suns = false, bounce = false, ground_reflects = false;
    CfemParams cfem;
    LightmapParams params;

    DrawnLight(uint32_t seed, const DrawnScene& scene)
    {
        std::mt19937 random(seed + 1000);
        const auto number = [&](double low, double high) { return drawn_surface::number(random, low, high); };
        const auto one_of = [&](int count) { return drawn_surface::one_of(random, count); };
        draw_environment(random);
        draw_albedo(scene.params.size(), random);
        suns = one_of(3) == 0;
        cfem.filter = one_of(3) ? "exact" : "sh";
        cfem.order = 1 + one_of(6);
        cfem.resolution = { 2 + one_of(15), 1 + one_of(9) };
        cfem.sanitize = true;
        params.model = drawn_model(scene.params, one_of(4));
        const auto angles = [&] {
            return std::vector<double> { number(-180, 180), number(-90, 90), number(-180, 180) };
        };
        switch (one_of(5)) {
        case 0:
            params.rotate = { 0, 0, 0 };
            break;
        case 1:
            params.matrix = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
            break;
        case 2:
            break;
        default:
            params.rotate = angles();
        }
        if (one_of(4) == 0)
            params.env_rotate = angles();
        if (one_of(4) == 0)
            params.exposure = number(-5, 5);
        bounce = one_of(2) == 0;
        ground_reflects = one_of(2) == 0;
    }

private:
    static std::string drawn_model(const VismapParams& map, int choice)
    {
        const bool has_normal = map.has("normal");
        return choice == 0 ? "lobe" : choice == 1 ? "paper" : choice == 2 && has_normal ? "ao" : "auto";
    }

    // One colour (also black, also of one pixel), all but one pixel, bright in one place, or anything.
    void draw_environment(std::mt19937& random)
    {
        const auto one_of = [&](int count) { return drawn_surface::one_of(random, count); };
        const int kind = one_of(6), channels = one_of(4) ? 3 : 1;
        const int width = kind == 4 ? 64 : 1 + one_of(24), height = kind == 4 ? 32 : 1 + one_of(12);
        OIIO::ImageSpec spec(width, height, channels, OIIO::TypeFloat);
        spec.channelnames
            = channels == 3 ? std::vector<std::string> { "R", "G", "B" } : std::vector<std::string> { "Y" };
        if (width > 2 && height > 2 && one_of(6) == 0)
            spec.attribute("oiio:sampleborder", 1);
        environment.reset(spec);
        std::array<float, 3> color;
        for (float& c : color)
            c = kind == 0 ? 0 : float(drawn_surface::number(random, 0, 2));
        OIIO::ImageBufAlgo::fill(environment, { color.data(), channels });
        if (kind == 5)
            OIIO::ImageBufAlgo::noise(environment, "uniform", 0, 2, false, one_of(1000));
        const std::array<float, 3> bright { 900, 800, 700 };
        // The last, so that all are looked at; or somewhere above.
        if (kind == 3)
            environment.setpixel(width - 1, height - 1, bright.data());
        if (kind == 4)
            set_pixel(random, width, height / 2, bright);
        if (one_of(6) == 0) {
            const std::array<float, 3> broken { std::numeric_limits<float>::quiet_NaN(), color[1], color[2] };
            set_pixel(random, width, height, broken);
        }
    }

    // In a drawn place of the columns and rows from 0 on.
    void set_pixel(std::mt19937& random, int columns, int rows, const std::array<float, 3>& color)
    {
        const int x = drawn_surface::one_of(random, columns), y = drawn_surface::one_of(random, rows);
        environment.setpixel(x, y, color.data());
    }

    // 1 everywhere or but for the last pixel, or anything, of the map's size or another.
    void draw_albedo(Size map, std::mt19937& random)
    {
        const auto one_of = [&](int count) { return drawn_surface::one_of(random, count); };
        const int kind = one_of(4), channels = one_of(4) ? 3 : 1;
        if (kind == 3)
            return;
        const bool other = one_of(3) == 0;
        const int width = other ? 1 + one_of(20) : map.width, height = other ? 1 + one_of(20) : map.height;
        OIIO::ImageSpec spec(width, height, channels, OIIO::TypeFloat);
        spec.channelnames
            = channels == 3 ? std::vector<std::string> { "R", "G", "B" } : std::vector<std::string> { "Y" };
        albedo.reset(spec);
        const std::array<float, 3> ones { 1, 1, 1 }, dark { 0.25f, 0.5f, 0.75f };
        OIIO::ImageBufAlgo::fill(albedo, { ones.data(), channels });
        if (kind == 1)
            albedo.setpixel(width - 1, height - 1, dark.data());
        if (kind == 2)
            OIIO::ImageBufAlgo::noise(albedo, "uniform", 0, 1, false, one_of(1000));
    }
};

} // namespace vmlight
