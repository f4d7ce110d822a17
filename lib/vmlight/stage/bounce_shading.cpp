// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/bounce_shading.h>

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/base/text_format.h>
#include <vmlight/cfem/radiance.h>
#include <vmlight/image/channels.h>
#include <vmlight/lightmap/shader.h>
#include <vmlight/stage/open_source.h>
#include <vmlight/stage/sun_choice.h>
#include <vmlight/vismap/point_visibility.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <array>

namespace vmlight {
namespace {

using OIIO::ImageBuf;

// Rays of a point that is no texel: a cell has several, and texels see many cells.
constexpr int kPointSamples = 64;

VismapParams point_params(const VismapParams& map)
{
    VismapParams params = map;
    params.samples = std::min(params.samples, kPointSamples);
    params.reconstruct = "off"; // points have no neighbours
    params.target_error = 0;
    return params;
}

bool read_visibility(std::vector<float>& dst, const ImageBuf& vismap, std::string& error)
{
    std::array<int, 4> index;
    if (!find_vismap_channels(vismap.spec(), index, error))
        return false;
    OIIO::ROI roi = vismap.roi();
    roi.chbegin = index[0];
    roi.chend = index[0] + 1;
    dst.resize(size_t(roi.npixels()));
    if (!vismap.get_pixels(roi, OIIO::TypeFloat, dst.data()))
        error = oiio::error_line(vismap);
    return error.empty();
}

// The texels' albedo, three floats each.
bool read_albedo(std::vector<float>& dst, const AlbedoReader& albedo, OIIO::ROI roi, std::string& error)
{
    dst.assign(3 * size_t(roi.npixels()), 1.0f);
    std::vector<float> scratch;
    BadValues faults;
    albedo.multiply(roi, dst.data(), scratch, faults, error);
    if (faults.any())
        error = albedo.fault_text(faults);
    return error.empty();
}

// Where V is 0 too: what such a texel sees may be lit from behind it. Or it is no texel, which the mesh alone says.
bool any_hidden(const std::vector<float>& visibility)
{
    return std::any_of(visibility.begin(), visibility.end(), [](float v) { return v < 1; });
}

Progress points_progress(const MakeOptions& options, const LightTransport& transport)
{
    return options.step("bounce points", int64_t(transport.points().size()), 1);
}

bool interrupted(std::string& error)
{
    error = "interrupted";
    return false;
}

} // namespace

std::shared_ptr<BounceShading> BounceShading::open(const LightmapRecipe& recipe, const PixelSource& vismap,
                                                   const OIIO::ImageSpec& light, std::shared_ptr<MapScene> scene,
                                                   std::string& error, const RecipeChain& chain)
{
    if (recipe.albedo.empty())
        error = "the bounce needs an albedo: set --albedo";
    else
        error = why_no_mesh(recipe, recipe.vismap);
    std::string config;
    if (!error.empty() || !stamp_config(config, recipe.colorconfig, error)) {
        error = with_location(recipe, "bounce", chain, error);
        return nullptr;
    }
    auto bounce = std::make_shared<BounceShading>();
    bounce->m_recipe = recipe;
    bounce->m_space = light.get_string_attribute("colorInteropID");
    bounce->m_key = format("bounce\n{}\n{}\n{}{}", bounce->m_space, config, scene->key(), vismap.key());
    bounce->m_recipe.bounce_params.visit([&](const char* name, auto& value, const auto& allowed, const char*) {
        bounce->m_key += std::string(name) + "=" + value_text(value, allowed) + "\n";
    });
    bounce->m_scene = std::move(scene);
    return bounce;
}

std::shared_ptr<BounceShading> BounceShading::of(const BounceParams& params, std::shared_ptr<MapScene> scene,
                                                 CasterColor color)
{
    auto bounce = std::make_shared<BounceShading>();
    bounce->m_recipe.bounce_params = params;
    bounce->m_scene = std::move(scene);
    bounce->m_color = std::move(color);
    return bounce;
}

void BounceShading::tag(OIIO::ImageSpec& lightmap) const
{
    BounceParams params = m_recipe.bounce_params;
    params.bounce = "auto"; // where there is a bounce, `on` is the same
    append_params(lightmap, params);
}

TransportParams BounceShading::transport_params() const
{
    TransportParams params;
    params.rays = m_recipe.bounce_params.bounce_rays;
    params.ground = m_recipe.bounce_params.ground_albedo > 0;
    return params;
}

bool BounceShading::forecast(TransportForecast& dst, const ImageBuf& vismap, const MakeOptions& options,
                             std::string& error)
{
    dst = {};
    std::vector<float> visibility;
    if (m_prepare.succeeded())
        return true;
    if (!read_visibility(visibility, vismap, error) || !m_scene->prepare(options, error))
        return false;
    const VismapParams& map = m_scene->params();
    return forecast_transport(dst, m_scene->scene(), map, visibility, transport_params(), options.threads,
                              options.step("prepare", 0, 0), m_scene->normal_map())
        || interrupted(error);
}

bool BounceShading::prepare(const std::vector<float>& visibility, const MakeOptions& options, std::string& error)
{
    if (!m_scene->prepare(options, error))
        return false;
    const Stopwatch timer;
    const VismapParams& map = m_scene->params();
    if (!m_transport.prepare(m_scene->scene(), map, visibility, transport_params(), error, options.threads,
                             options.step("bounce", map.size().width, map.size().height), m_scene->normal_map()))
        return false;
    const VismapParams samples = point_params(map);
    if (!bake_points(m_points, *m_scene->scene(), samples, m_transport.surfaces(), options.threads,
                     points_progress(options, m_transport)))
        return interrupted(error);
    if (m_color)
        m_albedo.find(*m_scene, m_transport.points(), Imath::V3f(float(m_recipe.bounce_params.ground_albedo)), m_color);
    else if (!m_albedo.read(*m_scene, m_transport.points(), m_recipe, m_space, options, error))
        return false;
    warn_of_unused(options);
    options.report(format(
        "bounce: {} in {:.3f} s, and {} off the map; {}", count_text(m_transport.rays(), "ray", "rays"), timer(),
        count_text(int64_t(m_transport.points().size()), "point", "points"),
        m_transport.is_kept() ? OIIO::Strutil::memformat(int64_t(m_transport.bytes())) + " are kept for other light"
                              : "traced again for other light, as memory is short"));
    return true;
}

// Whatever the light: only the meshes say it.
void BounceShading::warn_of_unused(const MakeOptions& options) const
{
    const BounceParams &given = m_recipe.bounce_params, defaults;
    if (options.repeated_inputs)
        return;
    if (given.ground_albedo > 0 && !m_scene->params().ground)
        options.report_warning("ground_albedo changes nothing: the visibility map has no ground");
    if (!m_color && given.bounce_albedo != defaults.bounce_albedo && !m_albedo.uses_bounce_albedo())
        options.report_warning(m_scene->recipe().occluder.empty()
                                   ? "bounce_albedo changes nothing: the visibility map has no occluder"
                                   : "bounce_albedo changes nothing: every occluder that lights a texel has a colour");
}

bool BounceShading::light_points(std::vector<float>& dst, const ImageBuf& vismap, OIIO::cspan<ImageBuf> cfem,
                                 const SunLight* suns, const LightmapParams& params, const MakeOptions& options,
                                 std::string& error) const
{
    const size_t count = m_transport.points().size();
    dst.assign(3 * count, 0.0f);
    if (count == 0)
        return true;
    ShadingModel model;
    Rotation rotation;
    LightmapShader shader;
    if (!lightmap_rotation(rotation, params, error)
        || !choose_model(model, params, vismap.spec(), has_all_light(cfem), error))
        return false;
    const OIIO::ROI roi(0, int(count), 0, 1, 0, 1, 0, 3);
    if (suns) {
        auto own = std::make_shared<SunLight>();
        own->suns = suns->suns;
        own->roi = roi;
        std::vector<Disc> discs;
        for (const Sun& sun : own->suns) // the inverse of a rotation is its transpose
            discs.push_back({ rotate(rotation.transposed(), sun.disc.direction), sun.disc.half_angle });
        if (!trace_points(own->visibility, *m_scene->scene(), m_scene->params(), m_transport.surfaces(), discs,
                          options.threads, points_progress(options, m_transport)))
            return interrupted(error);
        shader.use_suns(own);
    }
    if (!shader.prepare(cfem, params, model, error))
        return false;
    const std::vector<std::string> names = point_channels(m_scene->params());
    std::vector<size_t> index;
    for (const std::string& channel : model.channels) {
        const auto found = std::find(names.begin(), names.end(), channel);
        if (found == names.end()) {
            error = format("\"{}\": the metadata do not say how channel {} was baked, which the bounce needs",
                           m_recipe.vismap, channel);
            return false;
        }
        index.push_back(size_t(found - names.begin()));
    }
    std::vector<float> texels(count * index.size()), scratch;
    for (size_t i = 0; i < count; ++i)
        for (size_t c = 0; c < index.size(); ++c)
            texels[i * index.size() + c] = m_points[i * names.size() + index[c]];
    ShadeFaults faults;
    shader.shade(roi, TexelLayout::visibility_first, texels.data(), dst.data(), scratch, faults);
    if (faults.any())
        error = shader.fault_text(faults, "");
    return error.empty();
}

bool BounceShading::light(BounceLight& dst, const ImageBuf& vismap, OIIO::cspan<ImageBuf> cfem, const SunLight* suns,
                          const LightmapParams& params, const AlbedoReader& albedo, const MakeOptions& options,
                          std::string& error)
{
    dst.roi = vismap.roi();
    dst.light.clear();
    if (is_black(cfem, suns ? &suns->suns : nullptr)) {
        options.report("bounce: none, as the light is black");
        return true;
    }
    std::vector<float> reflected, points;
    if (!read_albedo(reflected, albedo, dst.roi, error))
        return false;
    std::vector<float> visibility;
    if (!read_visibility(visibility, vismap, error))
        return false;
    const bool is_hidden = any_hidden(visibility);
    if (!is_hidden || std::none_of(reflected.begin(), reflected.end(), [](float a) { return a > 0; })) {
        options.report(std::string("bounce: none, as ") + (is_hidden ? "the albedo is 0" : "no texel sees a surface"));
        return true;
    }
    if (!m_prepare.run([&](std::string& reason) { return prepare(visibility, options, reason); }, error))
        return false;
    LightmapParams unexposed = params;
    unexposed.exposure = 0;
    ImageBuf first;
    const auto step = [&] { return options.step("bounce", dst.roi.width(), dst.roi.height()); };
    if (!make_lightmap(first, vismap, cfem, suns, unexposed, nullptr, options.threads, step())) {
        error = oiio::error_line(first);
        return false;
    }
    if (!light_points(points, vismap, cfem, suns, unexposed, options, error))
        return false;
    m_albedo.multiply(points, reflected, m_transport);
    const auto* texel = static_cast<const float*>(first.localpixels());
    for (size_t i = 0; i < reflected.size(); ++i)
        reflected[i] *= texel[i];
    return m_transport.gather(dst.light, reflected, points, options.threads, step()) || interrupted(error);
}

} // namespace vmlight
