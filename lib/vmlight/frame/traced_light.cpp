// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/traced_light.h>

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/frame/explain_light.h>
#include <vmlight/frame/layers.h>
#include <vmlight/frame/surface_color.h>
#include <vmlight/frame/texel_albedo.h>
#include <vmlight/lightmap/input.h>
#include <vmlight/stage/open_source.h>
#include <vmlight/uv/udim.h>

namespace vmlight {
namespace {

using OIIO::ImageBuf;

// As far as texels of a cell are apart: see PointAlbedo.
constexpr double kCellReach = 1.0 / 64;

bool read_channel(std::vector<float>& dst, const ImageBuf& map, int channel, std::string& error)
{
    OIIO::ROI roi = map.roi();
    roi.chbegin = channel;
    roi.chend = channel + 1;
    dst.resize(size_t(roi.npixels()));
    error = map.get_pixels(roi, OIIO::TypeFloat, dst.data()) ? "" : oiio::error_line(map);
    return error.empty();
}

// What the rotation of `params` and the suns decide.
bool suns_key(std::string& dst, const SceneLight& light, const LightmapParams& params, std::string& error)
{
    Rotation rotation;
    if (!lightmap_rotation(rotation, params, error))
        return false;
    dst = suns_text(light.suns);
    for (int i = 0; i < 9; ++i)
        dst += format("|{}", rotation[i / 3][i % 3]);
    return true;
}

// "" too if it cannot be opened, which whoever reads its pixels reports.
std::string reason_of_file(const std::string& vismap)
{
    const std::vector<int> tiles = has_udim_pattern(vismap) ? existing_udims(recipe_path(vismap)) : std::vector<int>();
    LightmapRecipe recipe;
    recipe.vismap = tiles.empty() ? vismap : udim_path(vismap, tiles[0]);
    std::string ignored;
    const PixelSourcePointer source = open_input(recipe, "vismap", recipe.vismap, InputKind::Vismap, ignored, {});
    return source ? untraceable_reason(source->spec()) : "";
}

} // namespace

std::string untraceable_reason(const OIIO::ImageSpec& vismap)
{
    if (OIIO::get_roi(vismap) != OIIO::get_roi_full(vismap))
        return "the visibility map is only a part of one";
    const VismapRecipe recipe = recipe_of_map(vismap);
    return recipe.has_normal_map()
        ? "the visibility map was baked with a normal map, which traced light needs too; light its recipe with "
          "makelightmap, and show that with --texture"
        : "";
}

bool choose_trace(TraceParams& params, const std::string& vismap, const MakeOptions& options, std::string& error)
{
    const std::string reason = params.has_any() && !vismap.empty() ? reason_of_file(vismap) : "";
    if (reason.empty())
        return true;
    if (params.suns == "on" || params.bounce.bounce != "off") {
        error = format("\"{}\": {}", vismap, reason);
        return false;
    }
    options.report_warning("suns stay in the environment, with soft shadows: " + reason);
    params.suns = "off";
    return true;
}

TracedLight::TracedLight(const TraceParams& params, BakeScenePointer scene, int udim, FrameSurface surface,
                         std::vector<FrameSurface> others)
    : m_params(params)
    , m_bake(std::move(scene))
    , m_udim(udim)
    , m_surface(std::move(surface))
    , m_others(std::move(others))
{
}

bool TracedLight::trace_suns(const ImageBuf& map, const SceneLight& light, const LightmapParams& params,
                             const MakeOptions& options, std::string& error)
{
    std::string key;
    if (!suns_key(key, light, params, error))
        return false;
    if (key == m_suns_key)
        return true;
    m_suns_key.clear();
    if (!m_sun_shading) {
        LightmapRecipe recipe; // of error messages
        recipe.vismap = map.name();
        m_sun_shading = SunShading::open(recipe, map.spec(), m_scene, error, {});
        if (!m_sun_shading)
            return false;
    }
    const auto read = [&](int channel, std::vector<float>& dst, std::string& reason) {
        return read_channel(dst, map, channel, reason);
    };
    if (!m_sun_shading->light(m_suns, light.suns, params, read, options, error))
        return false;
    m_suns_key = key;
    return true;
}

// Made when it is first needed.
BounceShading& TracedLight::bounce_shading()
{
    const auto otherwise = float(m_params.bounce.bounce_albedo);
    if (!m_bounce_shading) {
        m_bounce_shading = BounceShading::of(m_params.bounce, m_scene, [this, otherwise](const LightPoint& point) {
            SeenPoint seen;
            seen.surface = &m_others[size_t(point.caster)];
            seen.triangle = point.triangle;
            const double second = double(point.u), third = double(point.v);
            seen.point.weight = { 1 - second - third, second, third };
            seen.point.weight_dx = seen.point.weight_dy = {};
            Imath::C3f albedo(otherwise, otherwise, otherwise);
            look_up_albedo(albedo, seen, kCellReach);
            return Imath::V3f(albedo);
        });
    }
    return *m_bounce_shading;
}

bool TracedLight::add_bounce(const ImageBuf& map, const SceneLight& light, const LightmapParams& params,
                             const MakeOptions& options, std::string& error)
{
    AlbedoReader albedo;
    return albedo.open(m_albedo, map.roi(), options.threads, error)
        && bounce_shading().light(m_bounce, map, light.filtered, suns(), params, albedo, options, error);
}

bool TracedLight::light(const ImageBuf& map, const SceneLight& light, const LightmapParams& params,
                        const MakeOptions& options, std::string& error)
{
    if (!m_scene)
        m_scene = MapScene::of(m_bake, map.spec(), m_udim);
    const bool has_bounce = m_params.bounce.bounce != "off";
    if (has_bounce && !m_albedo.initialized())
        m_albedo = texel_albedo(m_surface, map, m_udim, float(m_params.bounce.bounce_albedo), options.threads);
    if (options.explain
        && !explain_traced(m_surface.mesh->name, m_params, map, light, params, has_bounce ? &m_albedo : nullptr,
                           has_bounce ? &bounce_shading() : nullptr, options, error))
        return false;
    const bool has_suns = m_params.suns != "off" && !light.suns.empty();
    if (!has_suns)
        m_suns.suns.clear();
    return (!has_suns || trace_suns(map, light, params, options, error))
        && (!has_bounce || add_bounce(map, light, params, options, error));
}

bool TracedLight::failed() const
{
    return (m_sun_shading && m_sun_shading->failed()) || (m_bounce_shading && m_bounce_shading->failed());
}

} // namespace vmlight
