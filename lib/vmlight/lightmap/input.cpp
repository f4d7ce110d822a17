// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/input.h>

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/image/channels.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstring>
#include <numeric>

namespace vmlight {

using OIIO::ImageBuf;
using OIIO::ROI;

std::string named(const ImageBuf& image, const std::string& reason)
{
    return image.name().empty() ? reason : format("\"{}\": {}", image.name(), reason);
}

bool check_input(const ImageBuf& image, const char* what, std::string& error)
{
    if (!image.initialized()) {
        const std::string reason = oiio::error_line(image);
        error = named(image, reason.empty() ? format("no {}: the image is empty", what) : reason);
        return false;
    }
    if (image.deep() || image.spec().depth != 1) {
        error = named(image, format("not a {}: a {} image", what, image.deep() ? "deep" : "volume"));
        return false;
    }
    return true;
}

void find_not_finite(ROI roi, const float* pixels, int channels, BadValues& faults)
{
    for (int y = roi.ybegin; y < roi.yend; ++y)
        for (int x = roi.xbegin; x < roi.xend; ++x)
            for (int c = 0; c < channels; ++c)
                if (!std::isfinite(*pixels++))
                    faults.add(x, y, c);
}

bool VismapReader::open(const ImageBuf& image, const LightmapParams& params, bool has_stack, ShadingModel& model,
                        std::string& error)
{
    if (!check_input(image, "visibility map", error))
        return false;
    if (!choose_model(model, params, image.spec(), has_stack, error)) {
        error = named(image, error);
        return false;
    }
    m_index.clear();
    for (const std::string& channel : model.channels)
        m_index.push_back(image.spec().channelindex(channel));
    m_image = &image;
    const int channels = image.nchannels();
    const OIIO::stride_t pixel = OIIO::stride_t(sizeof(float)) * channels;
    const bool is_packed = image.localpixels() && image.pixeltype() == OIIO::TypeFloat && image.pixel_stride() == pixel
        && image.scanline_stride() == pixel * image.spec().width;
    m_pixels = is_packed ? static_cast<const float*>(image.localpixels()) : nullptr;

    std::vector<int> in_order(static_cast<size_t>(channels));
    std::iota(in_order.begin(), in_order.end(), 0);
    const bool is_last = m_index == std::vector<int> { 3, 0, 1, 2 } && channels == 4;
    m_is_in_place = is_packed && (is_last || m_index == in_order);
    m_layout = m_is_in_place && is_last ? TexelLayout::visibility_last : TexelLayout::visibility_first;

    const auto [first, last] = std::minmax_element(m_index.begin(), m_index.end());
    m_first = *first;
    m_end = *last + 1;
    m_runs.clear();
    for (const int index : m_index)
        if (!m_runs.empty() && m_first + m_runs.back().from + m_runs.back().count == index)
            ++m_runs.back().count;
        else
            m_runs.push_back({ index - m_first, 1 });
    return true;
}

// Copies four floats at a time, which is several times as fast as a copy of any length. What is copied too much is
// written again by what follows; the last texels, which have no other three floats behind them, are copied exactly.
void VismapReader::gather(float* dst, const float* texel, int stride, size_t texels) const
{
    const size_t exact = std::min(texels, size_t(3 / std::min(stride, channels()) + 1));
    for (size_t i = exact; i < texels; ++i, texel += stride)
        for (const Run& run : m_runs) {
            for (int k = 0; k < run.count; k += 4)
                std::memcpy(dst + k, texel + run.from + k, 4 * sizeof(float));
            dst += run.count;
        }
    for (size_t i = 0; i < exact; ++i, texel += stride)
        for (const Run& run : m_runs)
            dst = std::copy_n(texel + run.from, run.count, dst);
}

const float* VismapReader::read(ROI roi, std::vector<float>& scratch, std::string& error) const
{
    const OIIO::ImageSpec& spec = m_image->spec();
    const float* const pixels
        = m_pixels ? m_pixels + size_t(spec.nchannels) * size_t(roi.ybegin - spec.y) * spec.width : nullptr;
    if (m_is_in_place)
        return pixels;

    const size_t texels = size_t(roi.width()) * roi.height(), kept = texels * m_index.size();
    const int read = m_end - m_first;
    scratch.resize(kept + (pixels ? 0 : texels * size_t(read)));
    if (pixels) {
        gather(scratch.data(), pixels + m_first, spec.nchannels, texels);
        return scratch.data();
    }
    roi.chbegin = m_first;
    roi.chend = m_end;
    if (!m_image->get_pixels(roi, OIIO::TypeFloat, scratch.data() + kept)) {
        error = named(*m_image, oiio::error_line(*m_image));
        return nullptr;
    }
    gather(scratch.data(), scratch.data() + kept, read, texels);
    return scratch.data();
}

bool AlbedoReader::open(const ImageBuf& image, ROI roi, int nthreads, std::string& error)
{
    if (!check_input(image, "albedo", error))
        return false;
    if (!check_window(image.spec(), error) || !find_color_channels(image.spec(), m_index, error)) {
        error = named(image, error);
        return false;
    }
    m_image = m_original = &image;
    m_map = roi;
    const ROI own = image.roi_full(), stored = image.roi();
    m_dx = own.xbegin - roi.xbegin;
    m_dy = own.ybegin - roi.ybegin;
    if (own.width() == roi.width() && own.height() == roi.height())
        return true;

    // Checked before: a filter would spread a NaN and hide a negative value.
    BadValues faults;
    std::vector<float> row;
    for (int y = stored.ybegin; y < stored.yend; ++y)
        if (!read(ROI(stored.xbegin, stored.xend, y, y + 1, stored.zbegin, stored.zend), row, faults, error))
            return false;
    if (faults.any()) {
        error = fault_text(faults);
        return false;
    }
    m_resized.reset(OIIO::ImageSpec(roi.width(), roi.height(), image.nchannels(), OIIO::TypeFloat),
                    OIIO::InitializePixels::No);
    if (!oiio::resize(m_resized, image, m_resized.roi(), nthreads)) {
        error = named(image, oiio::error_line(m_resized));
        return false;
    }
    m_image = &m_resized;
    m_dx = -roi.xbegin;
    m_dy = -roi.ybegin;
    return true;
}

bool AlbedoReader::read(ROI roi, std::vector<float>& scratch, BadValues& faults, std::string& error) const
{
    const auto [first, last] = std::minmax_element(m_index.begin(), m_index.end());
    const int channels = *last - *first + 1;
    const size_t texels = size_t(roi.width()) * roi.height();
    roi.chbegin = *first;
    roi.chend = *last + 1;
    scratch.resize(texels * (3 + channels));
    float* read = scratch.data() + 3 * texels;
    if (!m_image->get_pixels(roi, OIIO::TypeFloat, read)) {
        error = named(*m_original, oiio::error_line(*m_image));
        return false;
    }
    const bool gray = m_index[0] == m_index[1];
    float* texel = scratch.data();
    for (size_t i = 0; i < texels; ++i, read += channels)
        for (int c = 0; c < 3; ++c, ++texel) {
            *texel = read[m_index[c] - *first];
            // The negated test is also true for NaN. A gray value is one fault.
            if (!(*texel >= 0 && *texel <= FLT_MAX) && (c == 0 || !gray))
                faults.add(roi.xbegin + int(i % roi.width()), roi.ybegin + int(i / roi.width()), m_index[c]);
        }
    return true;
}

void AlbedoReader::multiply(ROI roi, float* rgb, std::vector<float>& scratch, BadValues& faults,
                            std::string& error) const
{
    const size_t values = 3 * size_t(roi.width()) * roi.height();
    roi.xbegin += m_dx, roi.xend += m_dx;
    roi.ybegin += m_dy, roi.yend += m_dy;
    const ROI own = m_image->roi();
    roi.zbegin = own.zbegin, roi.zend = own.zend;
    if (!read(roi, scratch, faults, error))
        return;
    for (size_t i = 0; i < values; ++i)
        rgb[i] *= scratch[i];
}

bool AlbedoReader::is_one() const
{
    std::vector<float> colors;
    const auto is_one_in = [&](int first, int last, int y) {
        return read_of_map(first, last, y, colors)
            && std::all_of(colors.begin(), colors.end(), [](float v) { return v == 1; });
    };
    // One pixel tells of most.
    bool is_one = is_one_in(m_map.xbegin, m_map.xbegin + 1, m_map.ybegin);
    for (int y = m_map.ybegin; y < m_map.yend && is_one; ++y)
        is_one = is_one_in(m_map.xbegin, m_map.xend, y);
    return is_one;
}

bool AlbedoReader::find_range(float& low, float& high) const
{
    std::vector<float> colors;
    low = FLT_MAX, high = -FLT_MAX;
    for (int y = m_map.ybegin; y < m_map.yend; ++y) {
        if (!read_of_map(m_map.xbegin, m_map.xend, y, colors))
            return false;
        for (const float value : colors) { // NaN is reported by who multiplies by it
            low = std::min(low, value);
            high = std::max(high, value);
        }
    }
    return low <= high;
}

// Colours of part of a row of the map.
bool AlbedoReader::read_of_map(int first, int last, int y, std::vector<float>& colors) const
{
    BadValues ignored;
    std::string error;
    const ROI own = m_image->roi(), part(first + m_dx, last + m_dx, y + m_dy, y + m_dy + 1, own.zbegin, own.zend);
    if (!read(part, colors, ignored, error))
        return false;
    colors.resize(3 * size_t(last - first));
    return true;
}

std::string AlbedoReader::fault_text(const BadValues& faults) const
{
    return named(*m_original, faults.describe("albedo", "negative or not finite", m_original->spec().channelnames));
}

} // namespace vmlight
