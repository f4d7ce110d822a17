// SPDX-License-Identifier: Apache-2.0
/// Whole pictures of vmview, and how far two are apart.
#pragma once

#include "view_test.h"

#include "vmview/headless.h"
#include "vmview/render/lighting.h"
#include "vmview/scene/loading.h"

#include <cmath>

namespace vmlight::view {

inline Assets loaded(const Request& request)
{
    Assets assets;
    std::string error;
    EXPECT_TRUE(load_assets(assets, request, {}, error)) << error;
    return assets;
}

inline OIIO::ImageBuf drawn(const Assets& assets, const Request& request)
{
    OIIO::ImageBuf picture;
    std::string error;
    EXPECT_TRUE(render_headless(picture, assets, request, error)) << error;
    return picture;
}

/// Let `renderer` show these assets in the light of `request`.
inline void show_lit(Renderer& renderer, const Assets& assets, const Request& request)
{
    LightmapParams light;
    std::string error;
    ASSERT_TRUE(renderer.build(error) && renderer.set_mesh(assets.mesh, true, error)
                && renderer.set_map(assets.map, error) && renderer.set_light(assets.light, error)
                && light_params(light, request.light, 0, error) && show_surface(renderer, 0, "lit", light, error))
        << error;
}

/// Over the mean of `b`.
inline double relative_rmse(const OIIO::ImageBuf& a, const OIIO::ImageBuf& b)
{
    double squares = 0, sum = 0;
    OIIO::ImageBuf::ConstIterator<float> x(a), y(b);
    for (; !x.done(); ++x, ++y)
        for (int c = 0; c < 3; ++c) {
            squares += (x[c] - y[c]) * (x[c] - y[c]);
            sum += y[c];
        }
    const double count = 3.0 * double(a.spec().image_pixels());
    return std::sqrt(squares / count) / (sum / count);
}

} // namespace vmlight::view
