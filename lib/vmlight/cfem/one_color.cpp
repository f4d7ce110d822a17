// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cfem/one_color.h>

#include <vmlight/cfem/rows.h>
#include <vmlight/image/channels.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace vmlight {
namespace {

// Whether all of a row's pixels, `channels` floats each, have the color in the channels `index`.
bool is_all(const std::vector<float>& row, size_t channels, const std::array<int, 3>& index,
            const std::array<float, 3>& color)
{
    for (size_t i = 0; i < row.size(); i += channels)
        for (size_t c = 0; c < 3; ++c)
            if (row[i + size_t(index[c])] != color[c])
                return false;
    return true;
}

// Of its first pixel. 0 for -0, which is equal.
std::array<float, 3> first_of(const std::vector<float>& row, const std::array<int, 3>& index)
{
    return { row[size_t(index[0])] + 0.0f, row[size_t(index[1])] + 0.0f, row[size_t(index[2])] + 0.0f };
}

} // namespace

std::optional<OneColor> find_one_color(const Environment& env, bool sanitize)
{
    // With repair in any case: without, all bad values would be counted for a message.
    EnvironmentRows rows(env, true);
    if (!rows.open())
        return {};
    const std::array<int, 3> index { 0, 1, 2 };
    std::vector<float> row(size_t(3) * rows.grid().width);
    OneColor color;
    for (int y = 0; y < rows.grid().height; ++y) {
        if (!rows.read(y, row.data()) || (!sanitize && rows.bad_values() > 0))
            return {};
        if (y == 0)
            color.rgb = first_of(row, index);
        if (!is_all(row, 3, index, color.rgb))
            return {};
    }
    color.repaired = rows.bad_values();
    return color;
}

std::optional<std::array<float, 3>> find_one_color(OIIO::cspan<OIIO::ImageBuf> images)
{
    std::optional<std::array<float, 3>> color;
    for (const OIIO::ImageBuf& image : images) {
        const OIIO::ImageSpec& spec = image.spec();
        std::array<int, 3> index;
        std::string ignored;
        if (!find_color_channels(spec, index, ignored))
            return {};
        std::vector<float> row(size_t(spec.width) * size_t(spec.nchannels));
        for (int y = spec.y; y < spec.y + spec.height; ++y) {
            if (!image.get_pixels(
                    OIIO::ROI(spec.x, spec.x + spec.width, y, y + 1, spec.z, spec.z + 1, 0, spec.nchannels),
                    OIIO::TypeFloat, row.data()))
                return {};
            if (!color)
                color = first_of(row, index);
            if (!is_all(row, size_t(spec.nchannels), index, *color))
                return {};
        }
    }
    if (!color || !std::all_of(color->begin(), color->end(), [](float c) { return c >= 0 && std::isfinite(c); }))
        return {};
    return color;
}

void fill(std::vector<double>& rgb, const Size& size, const OneColor& color)
{
    rgb.resize(size_t(3) * size_t(size.width) * size_t(size.height));
    for (size_t i = 0; i < rgb.size(); ++i)
        rgb[i] = double(color.rgb[i % 3]);
}

} // namespace vmlight
