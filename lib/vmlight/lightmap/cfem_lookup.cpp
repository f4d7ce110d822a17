// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/cfem_lookup.h>

#include <vmlight/base/bad_values.h>
#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/image/channels.h>
#include <vmlight/math/latlong.h>

#include <algorithm>
#include <cmath>

namespace vmlight {
namespace {

// Row by row, and only the channels in use, so that a map in a cache is not copied as a whole.
bool read_rows(CfemLookup& dst, const OIIO::ImageBuf& cfem, const std::array<int, 3>& index, std::string& error)
{
    const OIIO::ImageSpec& spec = cfem.spec();
    const auto [first, last] = std::minmax_element(index.begin(), index.end());
    const int channels = *last - *first + 1;
    std::vector<float> row(size_t(dst.width) * channels);
    BadValues faults;
    for (int y = 0; y < dst.height; ++y) {
        const OIIO::ROI roi(spec.x, spec.x + dst.width, spec.y + y, spec.y + y + 1, spec.z, spec.z + 1, *first,
                            *last + 1);
        if (!cfem.get_pixels(roi, OIIO::TypeFloat, row.data())) {
            error = oiio::error_line(cfem);
            return false;
        }
        float* texel = &dst.texels[4 * (size_t(y + 1) * dst.pitch + 1)];
        for (int x = 0; x < dst.width; ++x, texel += 4)
            for (int c = 0; c < 3; ++c) {
                texel[c] = row[size_t(x) * channels + index[c] - *first];
                // A gray map is three channels here, but one to the user.
                dst.brightest[c] = std::max(dst.brightest[c], texel[c]);
                if (!std::isfinite(texel[c]) && (c == 0 || index[c] != index[0]))
                    faults.add(spec.x + x, spec.y + y, index[c]);
            }
    }
    if (faults.any())
        error = faults.describe("cosine-filtered environment", "not finite", spec.channelnames);
    return !faults.any();
}

// Row sums, in double: the mean of a row is the value of a pole, the weighted mean of the rows that of the sphere.
void row_mean(const CfemLookup& map, int y, double mean[3])
{
    mean[0] = mean[1] = mean[2] = 0;
    const float* texel = &map.texels[4 * (size_t(y + 1) * map.pitch + 1)];
    for (int x = 0; x < map.width; ++x, texel += 4)
        for (int c = 0; c < 3; ++c)
            mean[c] += texel[c];
    for (int c = 0; c < 3; ++c)
        mean[c] /= map.width;
}

void build_frame(CfemLookup& map)
{
    const auto texel = [&](int x, int y) { return &map.texels[4 * (size_t(y) * map.pitch + x)]; };

    double sphere[3] = { 0, 0, 0 };
    for (int y = 0; y < map.height; ++y) {
        double mean[3];
        row_mean(map, y, mean);
        for (int c = 0; c < 3; ++c)
            sphere[c] += mean[c] * latlong::row_solid_angle(y, map.height) / (4 * latlong::pi);

        const bool top = y == 0, bottom = y == map.height - 1;
        for (int x = 1; x <= map.width; ++x)
            for (int c = 0; c < 3; ++c) {
                const float beyond = float(2 * mean[c] - texel(x, y + 1)[c]);
                if (top)
                    texel(x, 0)[c] = beyond;
                if (bottom)
                    texel(x, map.height + 1)[c] = beyond;
            }
    }
    for (int y = 0; y < map.height + 2; ++y) {
        std::copy_n(texel(map.width, y), 4, texel(0, y));
        std::copy_n(texel(1, y), 4, texel(map.width + 1, y));
    }
    for (int x = 0; x < 2 * map.pitch; ++x)
        for (int c = 0; c < 3; ++c)
            texel(x, map.height + 2)[c] = float(sphere[c]);
}

} // namespace

bool check_cfem(const OIIO::ImageSpec& spec, std::string& error)
{
    const std::string stage = spec.get_string_attribute("vmlight:stage");
    if (!stage.empty() && stage != kCfemStage) {
        error = format("not a cosine-filtered environment: its vmlight:stage is \"{}\", not \"{}\"", stage, kCfemStage);
        return false;
    }
    std::array<int, 3> index;
    if (!find_color_channels(spec, index, error))
        return false;
    error = orientation_fault(spec);
    if (!error.empty())
        return false;
    if (OIIO::get_roi(spec) != OIIO::get_roi_full(spec)) {
        error = format("cosine-filtered environment is cropped: it stores {}x{} pixels of {}x{}", spec.width,
                       spec.height, spec.full_width, spec.full_height);
        return false;
    }
    if (spec.get_int_attribute("oiio:sampleborder")) {
        error = "cosine-filtered environment has samples on its borders, as maketx --envlatl makes them; use plain "
                "maketx, "
                "which keeps the pixels";
        return false;
    }
    // The vector kernel indexes texels with 32 bits.
    if ((int64_t(spec.width) + 2) * (int64_t(spec.height) + 4) > int64_t(1) << 28) {
        error = format("cosine-filtered environment of {}x{} pixels is too large; the limit is 2^28", spec.width,
                       spec.height);
        return false;
    }
    return true;
}

bool prepare_cfem(CfemLookup& dst, const OIIO::ImageBuf& cfem, std::string& error)
{
    const OIIO::ImageSpec& spec = cfem.spec();
    std::array<int, 3> index;
    if (!check_cfem(spec, error) || !find_color_channels(spec, index, error))
        return false;
    dst = {};
    dst.width = spec.width;
    dst.height = spec.height;
    dst.pitch = spec.width + 2;
    dst.texels.assign(4 * size_t(dst.pitch) * (spec.height + 4), 0.0f);
    if (!read_rows(dst, cfem, index, error))
        return false;
    build_frame(dst);
    for (float value : dst.texels)
        dst.largest = std::max(dst.largest, std::abs(value));
    if (!std::isfinite(dst.largest)) {
        error = "cosine-filtered environment has values too large to interpolate";
        return false;
    }
    return true;
}

} // namespace vmlight
