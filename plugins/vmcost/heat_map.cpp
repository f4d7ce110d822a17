// SPDX-License-Identifier: Apache-2.0
#include "heat_map.h"

#include "named_channels.h"

#include <vmlight/base/oiio_compat.h>
#include <vmlight/image/color.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>

namespace vmlight::cost {
namespace {

constexpr int kCoverageChannel = 6; // channel of a reference
constexpr float kUncovered = 0.55f; // grey

} // namespace

OIIO::ImageBuf heat_map(const OIIO::ImageBuf& lightmap, const OIIO::ImageBuf& reference)
{
    OIIO::ImageSpec spec(reference.spec().width, reference.spec().height, 4, OIIO::TypeFloat);
    spec.channelnames = kHeatMapChannels;
    spec.alpha_channel = -1;
    tag_data(spec);
    OIIO::ImageBuf map(spec);
    double sum = 0;
    int64_t count = 0;
    for (OIIO::ImageBuf::ConstIterator<float> truth(reference); !truth.done(); ++truth)
        if (truth[kCoverageChannel] > 0) {
            sum += (double(truth[0]) + truth[1] + truth[2]) / 3;
            ++count;
        }
    const double scale = sum > 0 ? double(count) / sum : 0;
    OIIO::ImageBuf::ConstIterator<float> truth(reference), model(lightmap);
    for (OIIO::ImageBuf::Iterator<float> texel(map); !texel.done(); ++texel, ++truth, ++model) {
        const bool covered = truth[kCoverageChannel] > 0;
        for (int c = 0; c < 3; ++c)
            texel[c] = covered ? float((model[c] - truth[c]) * scale) : 0;
        texel[3] = covered;
    }
    return map;
}

bool heat_map_png(std::string& png, const OIIO::ImageBuf& map, int side, std::string& error)
{
    const float third = 1 / (6 * kHeatRange);
    const float weights[4] = { third, third, third, 0 };
    OIIO::ImageBuf grey = OIIO::ImageBufAlgo::channel_sum(map, weights); // in [-0.5, 0.5]
    grey = OIIO::ImageBufAlgo::add(grey, 0.5f);
    const float knots[] = { 0.02f, 0.19f, 0.58f, 0.4f, 0.65f, 0.9f, 1, 1, 1, 0.95f, 0.5f, 0.35f, 0.6f, 0, 0.08f };
    OIIO::ImageBuf color = OIIO::ImageBufAlgo::color_map(grey, 0, 5, 3, knots);
    OIIO::ImageBuf::ConstIterator<float> covered(map);
    for (OIIO::ImageBuf::Iterator<float> pixel(color); !pixel.done(); ++pixel, ++covered)
        for (int c = 0; c < 3 && covered[3] == 0; ++c)
            pixel[c] = kUncovered;
    const int width = map.spec().width, height = map.spec().height;
    if (side > 0 && std::max(width, height) > side) {
        OIIO::ImageBuf small;
        oiio::resize(small, color, OIIO::ROI(0, side, 0, side * height / width, 0, 1, 0, 3), 0, "box");
        color = std::move(small);
    }
    OIIO::ImageSpec spec(color.spec().width, color.spec().height, 3, OIIO::TypeDesc::UINT8);
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const auto out = OIIO::ImageOutput::create("png");
    const bool written = out && out->set_ioproxy(&memory) && out->open("heat.png", spec)
        && out->write_image(OIIO::TypeDesc::FLOAT, color.localpixels()) && out->close();
    if (!written)
        error = "cannot encode a heat map as PNG: " + (out ? oiio::error_line(*out) : oiio::error_line());
    png.assign(bytes.begin(), bytes.end());
    return written;
}

} // namespace vmlight::cost
