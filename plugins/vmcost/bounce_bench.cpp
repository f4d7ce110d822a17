// SPDX-License-Identifier: Apache-2.0
#include "bounce_bench.h"

#include <vmlight/base/oiio_compat.h>

#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <utility>

namespace vmlight::cost {

BounceBench::BounceBench(BakeScenePointer scene, int udim, const OIIO::ImageBuf& map, int threads,
                         const Progress& progress)
    : m_map(map)
    , m_progress(progress)
{
    m_options.threads = threads;
    m_options.progress = [progress](const std::string&, int64_t) { return progress; };
    m_params.bounce = "on";
    const auto albedo = float(m_params.bounce_albedo);
    m_shading = BounceShading::of(m_params, MapScene::of(std::move(scene), map.spec(), udim),
                                  [albedo](const LightPoint&) { return Imath::V3f(albedo); });
    m_colors.reset(OIIO::ImageSpec(map.spec().width, map.spec().height, 3, OIIO::TypeFloat));
    OIIO::ImageBufAlgo::fill(m_colors, { albedo, albedo, albedo });
}

bool BounceBench::has_bounce() const
{
    return std::any_of(m_bounce.light.begin(), m_bounce.light.end(), [](float light) { return light > 0; });
}

bool BounceBench::light(OIIO::ImageBuf& dst, const std::vector<OIIO::ImageBuf>& images, const std::string& model,
                        std::string& error)
{
    LightmapParams params;
    params.model = model;
    AlbedoReader albedo;
    if (!albedo.open(m_colors, m_map.roi(), m_options.threads, error)
        || !m_shading->light(m_bounce, m_map, images, nullptr, params, albedo, m_options, error))
        return false;
    if (make_lightmap(dst, m_map, images, nullptr, m_bounce.light.empty() ? nullptr : &m_bounce, params, nullptr,
                      m_options.threads, m_progress))
        return true;
    error = oiio::error_line(dst);
    return false;
}

} // namespace vmlight::cost
