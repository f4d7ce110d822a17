// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/model_cells.h>

#include <vmlight/image/channels.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vmlight/lightmap/model_cells.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for each instruction set.
#include <hwy/highway.h>

#include <vmlight/lightmap/cell_vectors-inl.h>

HWY_BEFORE_NAMESPACE();
namespace vmlight {
namespace HWY_NAMESPACE {

bool ShadeCells(const CellLight& light, const ShadeSetup& setup, const float* vismap, size_t texels, float* rgb)
{
#if HWY_TARGET == HWY_SCALAR
    return shade_cells_scalar(light, setup, vismap, texels, rgb);
#else
    return ShadeTexels<CellsModel>(light, setup, vismap, texels, rgb);
#endif
}

} // namespace HWY_NAMESPACE
} // namespace vmlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vmlight {

HWY_EXPORT(ShadeCells);

bool shade_cells(const CellLight& light, const ShadeSetup& setup, const float* vismap, size_t texels, float* rgb)
{
    return HWY_DYNAMIC_DISPATCH(ShadeCells)(light, setup, vismap, texels, rgb);
}

bool shade_cells_scalar(const CellLight& light, const ShadeSetup& setup, const float* vismap, size_t texels, float* rgb)
{
    return shade_cells_one_by_one<CellsCodes>(light, setup, vismap, texels, rgb);
}

namespace {

struct CellsShader : ModelShader
{
    CellLight light;
    ShadeSetup setup;

    bool shade(TexelLayout, const float* vismap, size_t texels, float* rgb) const override
    {
        return shade_cells(light, setup, vismap, texels, rgb);
    }
};

} // namespace

std::vector<std::string> cells_model_channels(const OIIO::ImageSpec&)
{
    std::vector<std::string> names(kVismapChannels.begin(), kVismapChannels.end());
    names.insert(names.end(), kNormalChannels.begin(), kNormalChannels.end());
    for (const std::string& name : numbered_channels("cells", 0, kCellsFloats))
        names.push_back(name);
    return names;
}

bool has_cells(const OIIO::ImageSpec& vismap)
{
    return vismap.channelindex("cells.0") >= 0;
}

std::unique_ptr<ModelShader> prepare_cells(const ModelInput& input, std::string& error)
{
    auto shader = std::make_unique<CellsShader>();
    shader->setup = input.setup;
    const Rotation to_object = input.to_environment.transposed();
    if (!build_cells_light(shader->light, input.light[0], to_object, error))
        return nullptr;
    return shader;
}

} // namespace vmlight
#endif
