// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/model_mask.h>

#include <vmlight/image/channels.h>
#include <vmlight/lightmap/cell_sums.h>

namespace vmlight {
namespace {

bool shade_mask(const CellLight& light, const ShadeSetup& setup, const float* vismap, size_t texels, float* rgb)
{
    constexpr int kEdges = direction_grid::kSlices + 1;
    const float* running = light.running.data();
    return shade_cell_sums<kMaskFloats>(light, setup, vismap, texels, rgb, [&](CellSums& sums, const uint32_t* codes) {
        for (int column = 0; column < direction_grid::kColumns; ++column) {
            const MaskColumn view = unpack_mask(codes, column);
            if (view.density == 0)
                continue;
            const float* edges = running + column * kEdges * kMomentFloats;
            sums.add_between(edges + view.low * kMomentFloats, edges + view.high * kMomentFloats, float(view.density));
        }
    });
}

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
    if (!build_cell_light(shader->light, input.light[0], to_object, false, error))
        return nullptr;
    return shader;
}

} // namespace vmlight
