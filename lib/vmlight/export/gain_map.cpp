// SPDX-License-Identifier: Apache-2.0
#include <vmlight/export/lightmap_encoding.h>

#include <OpenImageIO/color.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace vmlight {
namespace {

// What keeps the logarithm of black finite; the one that the specification proposes.
constexpr double kOffset = 1.0 / 64;

// How many stops a display must reach beyond white for all of the gain to be applied: 1 for light that never exceeds
// white, as it must be more than 0.
constexpr double kLeastCapacity = 1;

double display_value(double linear, double steps)
{
    const double encoded = double(OIIO::linear_to_sRGB(float(std::min(linear, 1.0))));
    return std::round(encoded * steps) / steps;
}

std::string numbers_json(const std::array<double, 3>& least, const std::array<double, 3>& most)
{
    const std::array<double, 3> offset { kOffset, kOffset, kOffset };
    const nlohmann::ordered_json numbers {
        { "gainMapMin", least },
        { "gainMapMax", most },
        { "gamma", { 1, 1, 1 } },
        { "offsetSdr", offset },
        { "offsetHdr", offset },
        { "hdrCapacityMin", 0 },
        { "hdrCapacityMax", std::max(kLeastCapacity, *std::max_element(most.begin(), most.end())) },
    };
    return numbers.dump(2) + "\n";
}

} // namespace

bool encode_gain_map(std::vector<LightmapFile>& dst, const OIIO::ImageBuf& light, TextureDepth depth,
                     std::string& error)
{
    const double steps = largest_of(depth);
    OIIO::ImageBuf shown = light.copy(OIIO::TypeFloat), gain = light.copy(OIIO::TypeFloat);
    const auto* from = static_cast<const float*>(light.localpixels());
    auto *base = static_cast<float*>(shown.localpixels()), *stops = static_cast<float*>(gain.localpixels());
    const size_t count = 3 * light.spec().image_pixels();
    std::array<double, 3> least, most;
    for (size_t i = 0; i < count; ++i) {
        const double value = display_value(double(from[i]), steps);
        // Of the value that the file holds: the gain makes up for its rounding.
        const double linear = double(OIIO::sRGB_to_linear(float(value)));
        base[i] = float(value);
        stops[i] = float(std::log2((double(from[i]) + kOffset) / (linear + kOffset)));
        least[i % 3] = i < 3 ? double(stops[i]) : std::min(least[i % 3], double(stops[i]));
        most[i % 3] = i < 3 ? double(stops[i]) : std::max(most[i % 3], double(stops[i]));
    }
    for (size_t i = 0; i < count; ++i) {
        const double range = most[i % 3] - least[i % 3];
        stops[i] = range > 0 ? float((double(stops[i]) - least[i % 3]) / range) : 0;
    }
    TextureFile first { "png", "", "sRGB, for GainMapLoader" }, second { "png", "", "gain in stops" };
    if (!encode_png(first.bytes, shown, depth, error) || !encode_png(second.bytes, gain, depth, error))
        return false;
    dst.push_back({ "", first });
    dst.push_back({ "_gain", second });
    dst.push_back({ "_gain", { "json", numbers_json(least, most), "numbers of the gain" } });
    return true;
}

} // namespace vmlight
