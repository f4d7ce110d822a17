// SPDX-License-Identifier: Apache-2.0
#include "bench.h"

#include "compare.h"
#include "journal.h"
#include "timing.h"

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/base/parallel.h>
#include <vmlight/image/channels.h>
#include <vmlight/lightmap/sun_light.h>
#include <vmlight/reference/reference.h>
#include <vmlight/version.h>
#include <vmlight/vismap/baker.h>

#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>

namespace vmlight::cost {
namespace {

// Increment when the method of measurement changes: invalidates the rows of earlier journals.
constexpr int kMethod = 2;

template <class Params> std::string params_text(Params params)
{
    std::string text;
    params.visit([&](const char* name, auto& value, const auto& allowed, const char*) {
        text += format("{}={}\n", name, value_text(value, allowed));
    });
    return text;
}

VismapParams map_of(const Setting& setting, const CostParams& params)
{
    VismapParams map = reference_map(params);
    const int side = std::max(1, params.side() / setting.divisor);
    map.resolution = { side, side };
    map.samples = setting.samples;
    map.seed = params.seed;
    if (const ModelVariant* variant = find_variant(setting.model))
        variant->set_bake(map);
    return map;
}

// The traced candidate must not share random numbers with the reference.
int tracing_seed(const CostParams& params)
{
    return params.seed + 1000000001;
}

bool failed(const OIIO::ImageBuf& image, std::string& error)
{
    error = oiio::error_line(image);
    return false;
}

} // namespace

Bench::Bench(const Inputs& inputs, const CostParams& params, const MakeOptions& options)
    : m_inputs(inputs)
    , m_params(params)
    , m_options(options)
    , m_lights(inputs, params, options)
{
}

std::string Bench::key(const Setting& setting, size_t environment) const
{
    Setting copy = setting;
    std::string text = format("row {} {}\n{}{}\n", kMethod, VMLIGHT_VERSION_STRING, m_inputs.scene_text(),
                              m_inputs.environments[environment].reference_key);
    copy.visit([&](const char* name, auto& value) { text += format("{}={}\n", name, value); });
    text += params_text(map_of(setting, m_params));
    return hash_key(text + format("threads={}\n", worker_count(m_options.threads)));
}

bool Bench::measure(Row& row, OIIO::ImageBuf& picture, const Setting& setting, size_t environment,
                    const Progress& progress, std::string& error)
{
    const Environment& light = m_inputs.environments[environment];
    if (!m_visibility.initialized() && !bake_visibility(progress, error))
        return false;
    row = Row {};
    row.environment = light.name;
    row.setting = setting;
    const bool made = setting.model == kTraced
        ? trace(row, picture, setting, light, progress, error)
        : bake(setting, progress, error) && shade(row, picture, setting, environment, progress, error);
    if (made)
        row.errors = compare(picture, light.reference, m_visibility);
    return made;
}

bool Bench::bake_visibility(const Progress& progress, std::string& error)
{
    OIIO::ImageBuf vismap;
    if (!make_vismap(vismap, m_inputs.scene, reference_map(m_params), nullptr, m_options.threads, progress))
        return failed(vismap, error);
    m_visibility = OIIO::ImageBufAlgo::channels(vismap, 1, {}, {}, { kVismapChannels[0] });
    return true;
}

bool Bench::bake(const Setting& setting, const Progress& progress, std::string& error)
{
    const VismapParams map = map_of(setting, m_params);
    const std::string baked = params_text(map);
    if (baked == m_baked)
        return true;
    m_baked.clear();
    const auto make = [&] { return make_vismap(m_vismap, m_inputs.scene, map, nullptr, m_options.threads, progress); };
    if (!measure_time(m_bake, make))
        return failed(m_vismap, error);
    m_baked = baked;
    return true;
}

bool Bench::shade(Row& row, OIIO::ImageBuf& picture, const Setting& setting, size_t environment,
                  const Progress& progress, std::string& error)
{
    const ModelVariant& variant = *find_variant(setting.model);
    const FilteredLight* light
        = m_lights.find(environment, variant.model->light, setting.cfem_width, variant.suns, progress, error);
    if (!light)
        return false;
    const bool is_half = setting.storage == "half";
    OIIO::ImageBuf stored = m_vismap;
    if (is_half) { // as if written as half and read back
        stored.copy(m_vismap, OIIO::TypeDesc::HALF);
        stored.copy(OIIO::ImageBuf(stored), OIIO::TypeDesc::FLOAT);
    }
    LightmapParams params;
    params.model = variant.model->name;
    OIIO::ImageBuf lightmap;
    SunLight suns { light->suns, m_vismap.roi(), {} };
    std::vector<Disc> discs;
    for (const Sun& sun : suns.suns)
        discs.push_back(sun.disc);
    const VismapParams map = map_of(setting, m_params);
    if (!discs.empty() && m_sun_side != map.size().width) {
        if (!m_suns.prepare(m_inputs.scene, map, error, m_options.threads, progress))
            return false;
        m_sun_side = map.size().width;
    }
    const auto make = [&] {
        if (!discs.empty() && !m_suns.trace(suns.visibility, discs, m_options.threads, progress)) {
            lightmap.errorfmt("interrupted");
            return false;
        }
        return make_lightmap(lightmap, stored, light->images, discs.empty() ? nullptr : &suns, params, nullptr,
                             m_options.threads, progress);
    };
    Timing shade;
    if (!measure_time(shade, make))
        return failed(lightmap, error);
    row.shade = shade.seconds;
    row.spread = shade.spread;
    row.bake = m_bake.seconds;
    row.light = light->seconds;
    row.bytes = is_half ? variant.half_bytes() : variant.float_bytes();
    picture = resize_to_reference(lightmap, m_inputs.environments[environment].reference);
    return true;
}

bool Bench::trace(Row& row, OIIO::ImageBuf& picture, const Setting& setting, const Environment& environment,
                  const Progress& progress, std::string& error)
{
    ReferenceParams params;
    params.samples = std::max(2, setting.samples / 2); // pairs of rays
    params.seed = tracing_seed(m_params);
    params.sanitize = m_params.sanitize;
    OIIO::ImageBuf traced;
    const auto make = [&] {
        return make_reference(traced, *m_inputs.scene, environment.image, map_of(setting, m_params), {}, params,
                              m_options.threads, progress);
    };
    Timing shade;
    if (!measure_time(shade, make))
        return failed(traced, error);
    row.shade = shade.seconds;
    row.spread = shade.spread;
    picture = traced;
    return true;
}

} // namespace vmlight::cost
