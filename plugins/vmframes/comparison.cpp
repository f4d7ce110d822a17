// SPDX-License-Identifier: Apache-2.0
#include "comparison.h"

#include <vmlight/base/oiio_compat.h>

#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <cmath>

namespace vmlight::frames {
namespace {

using OIIO::ImageBuf;
using OIIO::ROI;

ImageBuf blank(int width, int height, const OIIO::ImageSpec& like)
{
    OIIO::ImageSpec spec = like;
    spec.width = spec.full_width = width;
    spec.height = spec.full_height = height;
    ImageBuf image(spec);
    OIIO::ImageBufAlgo::zero(image);
    return image;
}

} // namespace

double relative_rms(const ImageBuf& frame, const ImageBuf& reference)
{
    const int covered = reference.nchannels() - 1;
    double squares = 0, mean = 0, count = 0;
    ImageBuf::ConstIterator<float> a(frame);
    for (ImageBuf::ConstIterator<float> b(reference); !b.done(); ++a, ++b) {
        if (!(b[covered] > 0))
            continue;
        for (int c = 0; c < 3; ++c) {
            const double difference = double(a[c]) - double(b[c]);
            squares += difference * difference;
            mean += double(b[c]);
        }
        count += 3;
    }
    return mean > 0 ? std::sqrt(squares / count) / (mean / count) : 0;
}

ImageBuf side_by_side(const std::vector<ImageBuf>& frames)
{
    const int width = frames[0].spec().width, height = frames[0].spec().height;
    ImageBuf result = blank(width * int(frames.size()), height, frames[0].spec());
    for (size_t i = 0; i < frames.size(); ++i)
        OIIO::ImageBufAlgo::paste(result, int(i) * width, 0, 0, 0, frames[i]);
    return result;
}

ImageBuf wipe(const ImageBuf& left, const ImageBuf& right)
{
    const int width = left.spec().width, height = left.spec().height;
    ImageBuf result(left);
    for (ImageBuf::Iterator<float> pixel(result); !pixel.done(); ++pixel) {
        const double line = 0.5 * width + (0.5 * height - (pixel.y() + 0.5)) * 0.15, x = pixel.x() + 0.5;
        for (int c = 0; c < result.nchannels(); ++c) {
            if (std::abs(x - line) < 1)
                pixel[c] = 1;
            else if (x > line)
                pixel[c] = right.getchannel(pixel.x(), pixel.y(), 0, c);
        }
    }
    return result;
}

ImageBuf contact_sheet(const std::vector<ImageBuf>& frames, int width)
{
    const double aspect = double(frames[0].spec().width) / frames[0].spec().height;
    const double count = double(frames.size());
    const int columns = std::clamp(int(std::lround(std::sqrt(count * 1.5 / aspect))), 1, int(frames.size()));
    const int rows = (int(frames.size()) + columns - 1) / columns;
    const int cell = std::max(1, std::min(frames[0].spec().width, width / columns));
    const int high = std::max(1, int(std::lround(cell / aspect)));
    ImageBuf result = blank(columns * cell, rows * high, frames[0].spec());
    for (size_t i = 0; i < frames.size(); ++i) {
        ImageBuf small;
        oiio::resize(small, frames[i], ROI(0, cell, 0, high, 0, 1, 0, frames[i].nchannels()), 0);
        OIIO::ImageBufAlgo::paste(result, int(i) % columns * cell, int(i) / columns * high, 0, 0, small);
    }
    return result;
}

} // namespace vmlight::frames
