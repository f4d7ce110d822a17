// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/shader.h>

#include <vmlight/cfem/radiance.h>
#include <vmlight/cfem/stack.h>
#include <vmlight/image/channels.h>
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

// How the light was filtered, under the keys of a lightmap's recipe, whoever filtered it: `vmlight:order` of a CFEM is
// `vmlight:cfem_order` here. Which level of a stack is at hand says nothing: the model does.
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

// Values that are not finite, visibilities that are none, and packed numbers that are none any more.
void find_vismap_faults(OIIO::ROI roi, VismapOrder order, const ShadingModel& model, const float* texels,
                        ShadeFaults& faults)
{
    const bool last = order == VismapOrder::visibility_last;
    const int count = int(model.channels.size());

    for (int y = roi.ybegin; y < roi.yend; ++y)
        for (int x = roi.xbegin; x < roi.xend; ++x, texels += count)
            for (int c = 0; c < count; ++c) {
                const float value = texels[last ? (c + 3) % 4 : c];
                if (!std::isfinite(value))
                    faults.vismap.add(x, y, c);
                else if (c == 0 && std::abs(value) > kLargestVisibility)
                    faults.visibility.add(x, y, c);
                else if (is_packed_channel(model.channels[size_t(c)])
                         && !(value >= 0 && value < 0x1p24f && value == std::floor(value)))
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
    m_model = model;
    m_setup.gain = float(std::exp2(params.exposure));
    for (int i = 0; i < 9; ++i)
        m_setup.rotation[i] = float(rotation[i / 3][i % 3]);
    const bool prepared = model.light == ModelLight::cfem ? prepare_one(light, error)
        : model.light == ModelLight::lobes                ? prepare_stack(light, error)
                                                          : prepare_radiance(light, rotation, error);
    if (!prepared)
        error = named(light[0], error);
    return prepared;
}

bool LightmapShader::prepare_one(OIIO::cspan<OIIO::ImageBuf> light, std::string& error)
{
    // `ao` is `paper` with the normal in the direction's place.
    m_kernel = shade_paper;
    m_setup.cfem = &m_lookup;
    if (light.size() == 1 && find_radiance(light)) {
        error = "model " + m_model.name + " needs a cosine-filtered environment, and this is the environment itself";
        return false;
    }
    return prepare_cfem(m_lookup, light[0], error);
}

bool LightmapShader::prepare_stack(OIIO::cspan<OIIO::ImageBuf> light, std::string& error)
{
    m_kernel = shade_lobe;
    m_setup.lobes = &m_lobes;
    if (is_stack(light)) // the last image of a whole stack is no lobe
        return prepare_lobes(m_lobes, light.subspan(0, std::min<ptrdiff_t>(kStackLevels, light.size())), error);
    error = "model lobe needs a stack of lobes, and this is one cosine-filtered environment: make it anew with "
            "makecfem --stack";
    return false;
}

bool LightmapShader::prepare_radiance(OIIO::cspan<OIIO::ImageBuf> light, const Rotation& rotation, std::string& error)
{
    const OIIO::ImageBuf* radiance = find_radiance(light);
    if (!radiance) {
        error = OIIO::Strutil::fmt::format("model {} needs the environment itself, which is the last image of a stack: "
                                           "make it anew with makecfem --stack",
                                           m_model.name);
        return false;
    }
    m_setup.harmonics = &m_harmonics;
    m_setup.cells = &m_cells;
    if (m_model.name == "sh") {
        m_kernel = shade_harmonics;
        return prepare_harmonics(m_harmonics, *radiance, m_model.order, rotation, error);
    }
    m_kernel = m_model.name == "mask" ? shade_mask : shade_cells;
    return prepare_cells(m_cells, *radiance, rotation.transposed(), m_model.name == "cells", error);
}

void LightmapShader::shade(OIIO::ROI roi, VismapOrder order, const float* vismap, float* rgb,
                           std::vector<float>& scratch, ShadeFaults& faults) const
{
    ShadeFaults found;
    bool sound = m_kernel(m_setup, order, vismap, size_t(roi.width()) * roi.height(), rgb);
    if (!sound)
        find_vismap_faults(roi, order, m_model, vismap, found);
    if (m_albedo) {
        m_albedo->multiply(roi, rgb, scratch, found.albedo, found.error);
        sound = false;
    }
    // The kernel vouches for what it made, so that only doubtful regions, and those an albedo scaled, are read again.
    if (!sound && !found.any())
        find_not_finite(roi, rgb, 3, found.result);
    if (found.any())
        faults.merge(found);
}

std::string LightmapShader::fault_text(const ShadeFaults& faults, const std::string& vismap_name,
                                       const std::string& albedo_name) const
{
    const auto led_by = [](const std::string& name, const std::string& text) {
        return name.empty() ? text : OIIO::Strutil::fmt::format("\"{}\": {}", name, text);
    };
    if (!faults.error.empty())
        return faults.error;
    if (faults.vismap.any())
        return led_by(vismap_name, faults.vismap.text("visibility map", "not finite", m_model.channels));
    if (faults.visibility.any())
        return led_by(
            vismap_name,
            faults.visibility.text("visibility map", "too far outside [0, 1] for a visibility", m_model.channels));
    if (faults.packed.any())
        return led_by(vismap_name,
                      faults.packed.text("visibility map",
                                         "not whole numbers below 2^24 any more (was it resized, mipped or stored as "
                                         "half?)",
                                         m_model.channels));
    if (faults.albedo.any())
        return led_by(albedo_name, m_albedo->fault_text(faults.albedo));
    return faults.result.text("lightmap", "too large for float", std::array { "R", "G", "B" });
}

} // namespace vmlight
