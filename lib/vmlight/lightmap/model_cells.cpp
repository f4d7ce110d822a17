// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/model_cells.h>

#include <vmlight/image/channels.h>
#include <vmlight/lightmap/cell_sums.h>

namespace vmlight {
namespace {

bool shade_cells(const CellLight& light, const ShadeSetup& setup, const float* vismap, size_t texels, float* rgb)
{
    constexpr int kTriplesPerFloat = kCellsPerFloat / 3;
    constexpr size_t kTable = size_t(kTripleCodes) * kMomentFloats;
    const float* triples = light.triples.data();
    return shade_cell_sums<kCellsFloats>(light, setup, vismap, texels, rgb, [&](CellSums& sums, const uint32_t* codes) {
        const float* table = triples;
        for (int i = 0; i < kCellsFloats; ++i)
            for (int k = kTriplesPerFloat - 1; k >= 0; --k, table += kTable)
                if (const uint32_t code = codes[i] >> (6 * k) & 63)
                    sums.add(table + code * kMomentFloats);
    });
}

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
    if (!build_cell_light(shader->light, input.light[0], to_object, true, error))
        return nullptr;
    return shader;
}

} // namespace vmlight
