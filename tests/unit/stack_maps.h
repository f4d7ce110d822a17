// SPDX-License-Identifier: Apache-2.0
/// Stacks of lobes for the tests of shading: filtered, or given by a function of r and direction.
#pragma once

#include "lightmap_scene.h"

#include <vmlight/cfem/stack.h>
#include <vmlight/lightmap/lobe_lookup.h>

namespace scene {

inline std::vector<ImageBuf> filtered_stack(const ImageBuf& env, int width = 64)
{
    std::vector<ImageBuf> stack;
    vmlight::CfemParams params;
    params.resolution = { width, width / 2 };
    std::string error;
    EXPECT_TRUE(vmlight::make_cfem_stack(stack, env, params, error, 1)) << error;
    return stack;
}

inline std::vector<ImageBuf> stack_of(int width, int height, const std::function<V3f(double r, V3d direction)>& at)
{
    std::vector<ImageBuf> stack;
    for (int level = 0; level < vmlight::kStackLevels; ++level) {
        const double r = vmlight::stack_lobe(level);
        stack.push_back(cfem(width, height, [&](V3d direction) { return at(r, direction); }));
        stack.back().specmod().attribute("vmlight:stack", "true");
        stack.back().specmod().attribute("vmlight:lobe", float(r));
    }
    return stack;
}

/// A different colour in every texel of every level.
inline std::vector<ImageBuf> random_stack(int width, int height)
{
    std::mt19937 random(11);
    std::uniform_real_distribution<float> unit;
    return stack_of(width, height, [&](double, V3d) { return V3f(unit(random), unit(random), unit(random)); });
}

inline ImageBuf lit(const ImageBuf& vismap, const std::vector<ImageBuf>& stack,
                    const vmlight::LightmapParams& params = {}, int nthreads = 1)
{
    ImageBuf dst;
    EXPECT_TRUE(vmlight::make_lightmap(dst, vismap, stack, params, nullptr, nthreads)) << dst.geterror();
    return dst;
}

/// The error of a lightmap that cannot be made.
inline std::string refusal(const ImageBuf& vismap, OIIO::cspan<ImageBuf> light, const vmlight::LightmapParams& params)
{
    ImageBuf dst;
    EXPECT_FALSE(vmlight::make_lightmap(dst, vismap, light, params));
    EXPECT_FALSE(dst.initialized());
    return dst.geterror();
}

inline vmlight::LightmapParams model(const char* name)
{
    vmlight::LightmapParams params;
    params.model = name;
    return params;
}

} // namespace scene
