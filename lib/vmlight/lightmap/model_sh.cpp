// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/model_sh.h>

#include <vmlight/cfem/rows.h>
#include <vmlight/cfem/spherical_harmonics.h>
#include <vmlight/image/channels.h>
#include <vmlight/lightmap/brightest_light.h>
#include <vmlight/math/harmonics.h>
#include <vmlight/math/latlong.h>

#include <algorithm>
#include <cmath>

namespace vmlight {
namespace {

// Bands that `vismap` has all channels of; 2, those of V and B, if it has no others.
int complete_bands(const OIIO::ImageSpec& vismap)
{
    for (int bands = Harmonics::kLargestOrder; bands > 2; --bands) {
        const std::vector<std::string> names = numbered_channels("sh", 4, bands * bands);
        if (std::all_of(names.begin(), names.end(), [&](auto& name) { return vismap.channelindex(name) >= 0; }))
            return bands;
    }
    return 2;
}

struct HarmonicShader : ModelShader
{
    HarmonicLight light;
    ShadeSetup setup;

    bool shade(TexelLayout, const float* vismap, size_t texels, float* rgb) const override
    {
        return shade_harmonics(light, setup, vismap, texels, rgb);
    }
};

} // namespace

bool build_harmonic_light(HarmonicLight& dst, const OIIO::ImageBuf& radiance, int bands, const Rotation& to_environment,
                          std::string& error)
{
    EnvironmentRows rows(radiance, false);
    std::vector<double> projected;
    // On one thread: the caller may hold a lock, and a small map is projected in a millisecond.
    if (!rows.open()
        || !project_harmonics(projected, bands, rows.grid(), [&](int row, float* rgb) { return rows.read(row, rgb); },
                              1, {})) {
        error = rows.error();
        return false;
    }
    const std::vector<double> turned = rotate_harmonics(projected, bands, to_environment);
    find_brightest_light(dst.brightest, radiance);
    const int count = bands * bands;
    dst.count = count;
    dst.coefficients.assign(size_t(4 * count), 0.0f);
    // Y_0 is a constant; Y_1 is this times x, y, -z.
    const double constant = std::sqrt(0.25 / latlong::pi), linear = std::sqrt(0.75 / latlong::pi);
    const double scale[4] = { constant, linear, linear, -linear };
    for (int k = 0; k < count; ++k)
        for (int c = 0; c < 3; ++c)
            dst.coefficients[size_t(4 * k + c)] = float(turned[size_t(3 * k + c)] * (k < 4 ? scale[k] : 1));
    return true;
}

std::vector<std::string> sh_model_channels(const OIIO::ImageSpec& vismap)
{
    std::vector<std::string> names(kVismapChannels.begin(), kVismapChannels.end());
    const int bands = std::max(3, complete_bands(vismap));
    const std::vector<std::string> harmonics = numbered_channels("sh", 4, bands * bands);
    names.insert(names.end(), harmonics.begin(), harmonics.end());
    return names;
}

bool has_sh(const OIIO::ImageSpec& vismap)
{
    return complete_bands(vismap) > 2;
}

std::unique_ptr<ModelShader> prepare_sh(const ModelInput& input, std::string& error)
{
    auto shader = std::make_unique<HarmonicShader>();
    shader->setup = input.setup;
    const int bands = int(std::lround(std::sqrt(input.channels)));
    if (!build_harmonic_light(shader->light, input.light[0], bands, input.to_environment, error))
        return nullptr;
    return shader;
}

} // namespace vmlight
