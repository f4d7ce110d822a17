// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/shader.h>

#include <vmlight/base/format.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/cfem/one_color.h>
#include <vmlight/cfem/radiance.h>
#include <vmlight/cfem/stack.h>
#include <vmlight/image/channels.h>
#include <vmlight/lightmap/cfem_lookup.h>
#include <vmlight/lightmap/lobe_lookup.h>
#include <vmlight/lightmap/one_color_light.h>
#include <vmlight/math/rotation.h>
#include <vmlight/version.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vmlight {
namespace {

using OIIO::ImageSpec;

void copy_attribute(ImageSpec& dst, const ImageSpec& src, const char* name)
{
    if (const OIIO::ParamValue* value = src.find_attribute(name))
        dst.extra_attribs.push_back(*value);
}

// How the light was filtered, under the keys of a lightmap's recipe: `vmlight:order` of a CFEM is `vmlight:cfem_order`
// here. The level of a stack is left out: the model implies it.
void copy_filter(ImageSpec& dst, const ImageSpec& cfem, bool is_filtered)
{
    const std::string prefix = "vmlight:";
    if (cfem.get_string_attribute("vmlight:stage") != kCfemStage)
        return;
    for (OIIO::ParamValue value : cfem.extra_attribs) {
        const std::string name = value.name().string();
        const auto same = [&](const char* other) { return name == other; };
        const std::array kOthers { "vmlight:stage", "vmlight:version", "vmlight:stack", "vmlight:lobe" };
        const bool of_filter = name == "vmlight:filter" || name == "vmlight:order";
        if (!OIIO::Strutil::starts_with(name, prefix) || std::any_of(kOthers.begin(), kOthers.end(), same)
            || (of_filter && !is_filtered))
            continue;
        if (name != "vmlight:environment")
            value = OIIO::ParamValue(prefix + "cfem_" + name.substr(prefix.size()), value.type(), 1, value.data());
        dst.extra_attribs.push_back(value);
    }
}

// The images of `light` that the model reads; none, with the reason in `error`, if there are none.
OIIO::cspan<OIIO::ImageBuf> images_for(const ShadingModel& model, OIIO::cspan<OIIO::ImageBuf> light, std::string& error)
{
    const OIIO::ImageBuf* radiance = find_radiance(light);
    if (model.light == ModelLight::cfem) {
        if (light.size() > 1 || !radiance)
            return light.subspan(0, 1);
        error = format("model {} needs a cosine-filtered environment; this one is unfiltered", model.name);
    } else if (model.light == ModelLight::lobes) {
        if (is_stack(light)) // the last image of a whole stack is not a lobe
            return light.subspan(0, std::min<ptrdiff_t>(kStackLevels, light.size()));
        const bool is_of_strands = kernel_of(light[0].spec()) == kStrandKernel;
        error = format("model {} needs a stack of lobes, not a single {}-filtered environment; make one with "
                       "makecfem {}--stack",
                       model.name, is_of_strands ? "sine" : "cosine", is_of_strands ? "--kernel strand " : "");
    } else {
        if (radiance)
            return { radiance, 1 };
        error = format("model {} needs the unfiltered environment, the last image of a stack; make one with makecfem "
                       "--stack",
                       model.name);
    }
    return {};
}

// Set `error` as ModelEntry::prepare() would, if it is not for the pixels.
void check_light(ModelLight kind, OIIO::cspan<OIIO::ImageBuf> images, std::string& error)
{
    if (kind == ModelLight::lobes)
        check_lobes(images, error);
    else
        check_cfem(images[0].spec(), error);
}

// Values that are not finite, |V| out of range, and packed numbers that are no longer whole.
void find_vismap_faults(OIIO::ROI roi, TexelLayout layout, const ShadingModel& model, const float* texels,
                        ShadeFaults& faults)
{
    const bool last = layout == TexelLayout::visibility_last;
    const int count = int(model.channels.size()), first_whole = count - model.entry->whole_numbers;

    for (int y = roi.ybegin; y < roi.yend; ++y)
        for (int x = roi.xbegin; x < roi.xend; ++x, texels += count)
            for (int c = 0; c < count; ++c) {
                const float value = texels[last ? (c + 3) % 4 : c];
                if (!std::isfinite(value))
                    faults.vismap.add(x, y, c);
                else if (c == 0 && std::abs(value) > kLargestVisibility)
                    faults.visibility.add(x, y, c);
                else if (c >= first_whole && !(value >= 0 && value < 0x1p24f && value == std::floor(value)))
                    faults.packed.add(x, y, c);
            }
}

} // namespace

ImageSpec describe_lightmap(const ImageSpec& vismap, const ImageSpec& cfem, const LightmapParams& params,
                            const std::string& model)
{
    ImageSpec spec(vismap.width, vismap.height, 3, OIIO::TypeFloat);
    OIIO::set_roi(spec, OIIO::get_roi(vismap));
    OIIO::set_roi_full(spec, OIIO::get_roi_full(vismap));
    spec.attribute("vmlight:stage", kLightmapStage);
    spec.attribute("vmlight:version", VMLIGHT_VERSION_STRING);
    append_params(spec, params);
    spec.attribute("vmlight:model", model);
    for (const char* name : { "vmlight:mesh", "vmlight:meshHash" })
        copy_attribute(spec, vismap, name);
    copy_filter(spec, cfem, !reads_radiance(model));
    for (const char* name : { "colorInteropID", "chromaticities" })
        copy_attribute(spec, cfem, name);
    return spec;
}

void ShadeFaults::merge(const ShadeFaults& other)
{
    vismap.merge(other.vismap);
    visibility.merge(other.visibility);
    packed.merge(other.packed);
    albedo.merge(other.albedo);
    result.merge(other.result);
    if (!other.error.empty())
        error = other.error;
}

bool LightmapShader::prepare(OIIO::cspan<OIIO::ImageBuf> light, const LightmapParams& params, const ShadingModel& model,
                             std::string& error)
{
    Rotation rotation;
    if (!lightmap_rotation(rotation, params, error))
        return false;
    for (const OIIO::ImageBuf& image : light)
        if (!check_input(image, "cosine-filtered environment", error))
            return false;
    if (light[0].spec().find_attribute(kSunsAttribute) && !m_suns) {
        error = named(light[0],
                      "its suns were split off (makecfem --suns auto), and without them it is too dark; light "
                      "with them (makelightmap --suns auto), or filter the environment whole");
        return false;
    }
    m_model = model;
    ModelInput input { images_for(model, light, error), rotation, {}, int(model.channels.size()) };
    m_gain = std::exp2(params.exposure);
    input.setup.gain = float(m_gain);
    for (int i = 0; i < 9; ++i)
        input.setup.rotation[i] = float(rotation[i / 3][i % 3]);
    m_shader = nullptr;
    const auto color = error.empty() ? find_one_color(input.light) : std::nullopt;
    m_looks_up = !color || !params.skip_one_color;
    if (error.empty() && m_looks_up)
        m_shader = model.entry->prepare(input, error);
    else if (error.empty())
        check_light(model.light, input.light, error);
    if (color && error.empty())
        m_shader = one_color_shader(*color, model, input.setup.gain, std::move(m_shader));
    if (!m_shader)
        error = named(light[0], error);
    return m_shader != nullptr;
}

void LightmapShader::use_albedo(std::shared_ptr<const AlbedoReader> albedo, bool skip_one)
{
    m_albedo = skip_one && albedo->is_one() ? nullptr : std::move(albedo);
}

void LightmapShader::shade(OIIO::ROI roi, TexelLayout layout, const float* vismap, float* rgb,
                           std::vector<float>& scratch, ShadeFaults& faults) const
{
    ShadeFaults found;
    const size_t texels = size_t(roi.width()) * roi.height();
    if (m_looks_up)
        work_counts().texels_looked_up += int64_t(texels);
    bool sound = m_shader->shade(layout, vismap, texels, rgb);
    if (!sound)
        find_vismap_faults(roi, layout, m_model, vismap, found);
    if (m_suns && !m_suns->suns.empty()) {
        m_suns->add(roi, m_gain, rgb);
        sound = false;
    }
    if (m_bounce) {
        m_bounce->add(roi, m_gain, rgb);
        sound = false;
    }
    if (m_albedo) {
        work_counts().texels_multiplied += int64_t(texels);
        m_albedo->multiply(roi, rgb, scratch, found.albedo, found.error);
        sound = false;
    }
    // Only regions that the model did not vouch for, and those that suns or an albedo changed, are read again.
    if (!sound && !found.any())
        find_not_finite(roi, rgb, 3, found.result);
    if (found.any())
        faults.merge(found);
}

std::string LightmapShader::fault_text(const ShadeFaults& faults, const std::string& vismap_name,
                                       const std::string& albedo_name) const
{
    const auto led_by = [](const std::string& name, const std::string& text) {
        return name.empty() ? text : format("\"{}\": {}", name, text);
    };
    if (!faults.error.empty())
        return faults.error;
    if (faults.vismap.any())
        return led_by(vismap_name, faults.vismap.describe("visibility map", "not finite", m_model.channels));
    if (faults.visibility.any())
        return led_by(vismap_name,
                      faults.visibility.describe("visibility map", "outside [-2, 2] and so cannot be visibility",
                                                 m_model.channels));
    if (faults.packed.any())
        return led_by(vismap_name,
                      faults.packed.describe("visibility map",
                                             "no longer whole and below 2^24 (was the map resized, mipmapped or stored "
                                             "as half?)",
                                             m_model.channels));
    if (faults.albedo.any())
        return led_by(albedo_name, m_albedo->fault_text(faults.albedo));
    return faults.result.describe("lightmap", "too large for float", std::array { "R", "G", "B" });
}

} // namespace vmlight
