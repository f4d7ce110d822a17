// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/model_mask.h>

#include <vmlight/image/channels.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vmlight/lightmap/model_mask.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for each instruction set.
#include <hwy/highway.h>

#include <vmlight/lightmap/cell_vectors-inl.h>

HWY_BEFORE_NAMESPACE();
namespace vmlight {
namespace HWY_NAMESPACE {

bool ShadeMask(const CellLight& light, const ShadeSetup& setup, const float* vismap, size_t texels, float* rgb)
{
#if HWY_TARGET == HWY_SCALAR
    return shade_mask_scalar(light, setup, vismap, texels, rgb);
#else
    return ShadeTexels<MaskModel>(light, setup, vismap, texels, rgb);
#endif
}

} // namespace HWY_NAMESPACE
} // namespace vmlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vmlight {

HWY_EXPORT(ShadeMask);

bool shade_mask(const CellLight& light, const ShadeSetup& setup, const float* vismap, size_t texels, float* rgb)
{
    return HWY_DYNAMIC_DISPATCH(ShadeMask)(light, setup, vismap, texels, rgb);
}

bool shade_mask_scalar(const CellLight& light, const ShadeSetup& setup, const float* vismap, size_t texels, float* rgb)
{
    return shade_cells_one_by_one<MaskCodes>(light, setup, vismap, texels, rgb);
}

namespace {

struct MaskShader : ModelShader
{
    CellLight light;
    ShadeSetup setup;

    bool shade(TexelLayout, const float* vismap, size_t texels, float* rgb) const override
    {
        return shade_mask(light, setup, vismap, texels, rgb);
    }
};

} // namespace

std::vector<std::string> mask_model_channels(const OIIO::ImageSpec&)
{
    std::vector<std::string> names(kVismapChannels.begin(), kVismapChannels.end());
    names.insert(names.end(), kNormalChannels.begin(), kNormalChannels.end());
    for (const std::string& name : numbered_channels("mask", 0, kMaskFloats))
        names.push_back(name);
    return names;
}

bool has_mask(const OIIO::ImageSpec& vismap)
{
    return vismap.channelindex("mask.0") >= 0;
}

std::unique_ptr<ModelShader> prepare_mask(const ModelInput& input, std::string& error)
{
    auto shader = std::make_unique<MaskShader>();
    shader->setup = input.setup;
    const Rotation to_object = input.to_environment.transposed();
    if (!build_mask_light(shader->light, input.light[0], to_object, error))
        return nullptr;
    return shader;
}

} // namespace vmlight
#endif
