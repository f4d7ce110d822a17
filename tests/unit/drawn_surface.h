// SPDX-License-Identifier: Apache-2.0
/// Surfaces drawn at random: cut-outs and normal maps, with those that change nothing among them.
#pragma once

#include <vmlight/mesh/opacity.h>
#include <vmlight/vismap/normal_map_params.h>

#include <OpenImageIO/imagebuf.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

namespace vmlight::drawn_surface {

inline double number(std::mt19937& random, double low, double high)
{
    return std::uniform_real_distribution<double>(low, high)(random);
}

inline int one_of(std::mt19937& random, int count)
{
    return std::uniform_int_distribution<int>(0, count - 1)(random);
}

/// Alpha of 1 or of 0 everywhere, a checker, or anything.
inline std::shared_ptr<const AlphaTexture> alpha(std::mt19937& random)
{
    const int width = 1 + one_of(random, 8), height = 1 + one_of(random, 8), kind = one_of(random, 4);
    std::vector<float> texels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            texels.push_back(kind < 2 ? float(kind) : kind == 2 ? float((x + y) % 2) : float(number(random, 0, 1)));
    const TextureWrap wrap = one_of(random, 2) ? TextureWrap::periodic : TextureWrap::clamp;
    return std::make_shared<AlphaTexture>(width, height, std::move(texels), wrap, wrap, one_of(random, 2) == 0);
}

/// Give each triangle of a mesh one of three materials.
inline void cut_out(Mesh& mesh, std::mt19937& random)
{
    constexpr std::array kModes { AlphaMode::opaque, AlphaMode::mask, AlphaMode::mask, AlphaMode::blend };
    auto opacity = std::make_shared<MeshOpacity>();
    opacity->materials.resize(3);
    for (MaterialOpacity& material : opacity->materials) {
        material.mode = kModes[size_t(one_of(random, int(kModes.size())))];
        material.cutoff = number(random, 0.05, 0.95);
        material.factor = one_of(random, 3) ? 1 : number(random, 0, 1);
        if (one_of(random, 4))
            material.textures[0].image = alpha(random);
    }
    mesh.materials.resize(3);
    mesh.triangle_materials.clear();
    while (mesh.triangle_materials.size() < mesh.triangles.size())
        mesh.triangle_materials.push_back(uint32_t(one_of(random, 3)));
    mesh.opacity = std::move(opacity);
}

/// Flat, leaning one way, or bumpy.
inline OIIO::ImageBuf normal_map(NormalMapParams& params, std::mt19937& random)
{
    const int kind = one_of(random, 3);
    const double lean = kind == 0 ? 0 : number(random, 0.05, 0.6), x = number(random, -1, 1), y = number(random, -1, 1);
    params.normal_map_space = kind > 0 && one_of(random, 4) == 0 ? "object" : "tangent";
    params.normal_map_green = one_of(random, 2) ? "up" : "down";
    const int width = 1 + one_of(random, 9), height = 1 + one_of(random, 9);
    OIIO::ImageBuf image(OIIO::ImageSpec(width, height, 3, OIIO::TypeFloat));
    for (OIIO::ImageBuf::Iterator<float> pixel(image); !pixel.done(); ++pixel) {
        const double a = kind == 2 ? number(random, -1, 1) : x, b = kind == 2 ? number(random, -1, 1) : y;
        const double length = std::sqrt(1 + lean * lean * (a * a + b * b));
        pixel[0] = float(0.5 + 0.5 * a * lean / length);
        pixel[1] = float(0.5 + 0.5 * b * lean / length);
        pixel[2] = float(0.5 + 0.5 / length);
    }
    return image;
}

} // namespace vmlight::drawn_surface
