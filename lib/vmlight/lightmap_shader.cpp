// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap_shader.h>

#include <vmlight/channels.h>
#include <vmlight/rotation.h>

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
void copy_filter(ImageSpec& dst, const ImageSpec& cfem)
{
    const std::string prefix = "vmlight:";
    if (cfem.get_string_attribute("vmlight:stage") != kCfemStage)
        return;
    for (OIIO::ParamValue value : cfem.extra_attribs) {
        const std::string name = value.name().string();
        const auto same = [&](const char* other) { return name == other; };
        const std::array kOthers { "vmlight:stage", "vmlight:version", "vmlight:stack", "vmlight:lobe" };
        if (!OIIO::Strutil::starts_with(name, prefix) || std::any_of(kOthers.begin(), kOthers.end(), same))
            continue;
        if (name != "vmlight:environment")
            value = OIIO::ParamValue(prefix + "cfem_" + name.substr(prefix.size()), value.type(), 1, value.data());
        dst.extra_attribs.push_back(value);
    }
}

void find_vismap_faults(OIIO::ROI roi, VismapOrder order, const float* texels, Faults& faults)
{
    const bool last = order == VismapOrder::visibility_last;
    for (int y = roi.ybegin; y < roi.yend; ++y)
        for (int x = roi.xbegin; x < roi.xend; ++x, texels += 4)
            for (int c = 0; c < 4; ++c)
                if (!std::isfinite(texels[last ? (c + 3) % 4 : c]))
                    faults.add(x, y, c);
}

} // namespace

ImageSpec describe_lightmap(const ImageSpec& vismap, const ImageSpec& cfem, const LightmapParams& params,
                            bool has_stack)
{
    ImageSpec spec(vismap.width, vismap.height, 3, OIIO::TypeFloat);
    OIIO::set_roi(spec, OIIO::get_roi(vismap));
    OIIO::set_roi_full(spec, OIIO::get_roi_full(vismap));
    spec.attribute("vmlight:stage", kLightmapStage);
    spec.attribute("vmlight:version", VMLIGHT_VERSION);
    append_params(spec, params);
    spec.attribute("vmlight:model", lightmap_model(params, has_stack));
    for (const char* name : { "vmlight:mesh", "vmlight:meshHash" })
        copy_attribute(spec, vismap, name);
    copy_filter(spec, cfem);
    for (const char* name : { "colorInteropID", "chromaticities" })
        copy_attribute(spec, cfem, name);
    return spec;
}

void ShadeFaults::merge(const ShadeFaults& other)
{
    vismap.merge(other.vismap);
    albedo.merge(other.albedo);
    result.merge(other.result);
    if (!other.error.empty())
        error = other.error;
}

bool LightmapShader::prepare(OIIO::cspan<OIIO::ImageBuf> cfem, const LightmapParams& params, std::string& error)
{
    Rotation rotation;
    if (!lightmap_rotation(rotation, params, error))
        return false;
    for (const OIIO::ImageBuf& level : cfem)
        if (!check_input(level, "cosine-filtered environment", error))
            return false;
    const bool lobe = lightmap_model(params, is_stack(cfem)) == "lobe";
    if (lobe && !is_stack(cfem))
        error = "model lobe needs a stack of lobes, and this is one cosine-filtered environment: make it anew with "
                "makecfem --stack";
    if (!error.empty() || !(lobe ? prepare_lobes(m_lobes, cfem, error) : prepare_cfem(m_lookup, cfem[0], error))) {
        error = named(cfem[0], error);
        return false;
    }
    // `ao` is `paper` with the normal in the direction's place.
    m_kernel = lobe ? shade_lobe : shade_paper;
    m_vismap_channels = kVismapChannels;
    if (params.model == "ao")
        std::copy(kNormalChannels.begin(), kNormalChannels.end(), m_vismap_channels.begin() + 1);
    m_setup.cfem = &m_lookup;
    m_setup.lobes = &m_lobes;
    m_setup.gain = float(std::exp2(params.exposure));
    for (int i = 0; i < 9; ++i)
        m_setup.rotation[i] = float(rotation[i / 3][i % 3]);
    return true;
}

void LightmapShader::shade(OIIO::ROI roi, VismapOrder order, const float* vismap, float* rgb,
                           std::vector<float>& scratch, ShadeFaults& faults) const
{
    ShadeFaults found;
    bool sound = m_kernel(m_setup, order, vismap, size_t(roi.width()) * roi.height(), rgb);
    if (!sound)
        find_vismap_faults(roi, order, vismap, found.vismap);
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
        return led_by(vismap_name, faults.vismap.text("visibility map", "not finite", m_vismap_channels));
    if (faults.albedo.any())
        return led_by(albedo_name, m_albedo->fault_text(faults.albedo));
    return faults.result.text("lightmap", "too large for float", std::array { "R", "G", "B" });
}

} // namespace vmlight
