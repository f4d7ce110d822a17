// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cfem/rows.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/image/channels.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vmlight {

EnvironmentRows::EnvironmentRows(Environment env, bool sanitize)
    : m_env(std::move(env))
    , m_sanitize(sanitize)
{
}

bool EnvironmentRows::open()
{
    const OIIO::ImageSpec& spec = m_env.spec();
    m_error = m_env.fault();
    if (!m_error.empty())
        return false;
    std::array<int, 3> index;
    if (!check_window(spec, m_error) || !find_color_channels(spec, index, m_error)) {
        m_error = printable_line("environment: " + m_error);
        return false;
    }
    // The display window is the sphere: a cropped map is black outside its pixels.
    m_roi = OIIO::get_roi_full(spec);
    const auto range = std::minmax_element(index.begin(), index.end());
    m_roi.chbegin = *range.first;
    m_roi.chend = *range.second + 1;
    for (int k = 0; k < 3; ++k)
        m_channels[k] = index[k] - m_roi.chbegin;

    const bool border = spec.get_int_attribute("oiio:sampleborder") != 0;
    m_grid = { m_roi.width(), m_roi.height(), border };
    m_row.resize(size_t(m_roi.nchannels()) * m_grid.width);
    for (std::vector<float>& row : m_window)
        row.resize(size_t(3) * m_grid.width);
    return true;
}

bool EnvironmentRows::read(int row, float* rgb)
{
    // A repair needs the row below as well.
    const int needed = std::min(m_grid.height, m_sanitize ? row + 2 : row + 1);
    while (m_loaded < needed)
        if (!load(m_loaded))
            return false;
    if (m_window_bad[row % 3] && !m_sanitize) {
        while (m_loaded < m_grid.height)
            if (!load(m_loaded))
                return false;
        const char* wrong = !m_negative.any() ? "NaN or infinite"
            : !m_not_finite.any()             ? "negative"
                                              : "NaN, infinite or negative";
        BadValues all = m_not_finite;
        all.merge(m_negative);
        m_error = printable_line(all.describe("environment", wrong, m_env.spec().channelnames))
            + format("; set sanitize to repair {}", plural(all.count(), "it", "them"));
        return false;
    }
    std::copy(window(row).begin(), window(row).end(), rgb);
    if (m_window_bad[row % 3])
        repair(row, rgb);
    return true;
}

bool EnvironmentRows::load(int row)
{
    OIIO::ROI roi = m_roi;
    roi.ybegin = m_roi.ybegin + row;
    roi.yend = roi.ybegin + 1;
    if (!m_env.read(roi, m_row.data(), m_error))
        return false;

    const int stride = m_roi.nchannels();
    std::vector<float>& rgb = window(row);
    bool good = true;
    for (int x = 0; x < m_grid.width; ++x)
        for (int k = 0; k < 3; ++k) {
            const float value = m_row[size_t(stride) * x + m_channels[k]];
            rgb[size_t(3) * x + k] = value;
            good &= value >= 0 && value <= std::numeric_limits<float>::max();
        }
    m_window_bad[row % 3] = !good;
    m_loaded = row + 1;
    if (good)
        return true;

    // A map of one channel counts once.
    const int distinct = stride == 1 ? 1 : 3;
    for (int x = 0; x < m_grid.width; ++x)
        for (int k = 0; k < distinct; ++k) {
            const float value = rgb[size_t(3) * x + k];
            const bool finite = std::isfinite(value);
            if (!finite || value < 0)
                (finite ? m_negative : m_not_finite).add(m_roi.xbegin + x, roi.ybegin, m_roi.chbegin + m_channels[k]);
        }
    return true;
}

void EnvironmentRows::repair(int row, float* rgb) const
{
    const int width = m_grid.width;
    for (int x = 0; x < width; ++x)
        for (int k = 0; k < 3; ++k) {
            float& value = rgb[size_t(3) * x + k];
            if (std::isfinite(value)) {
                value = std::max(0.0f, value);
                continue;
            }
            double sum = 0;
            int count = 0;
            for (int j = std::max(0, row - 1); j <= std::min(m_grid.height - 1, row + 1); ++j)
                for (int i = -1; i <= 1; ++i) {
                    const float near = window(j)[size_t(3) * ((x + i + width) % width) + k];
                    if (std::isfinite(near) && near >= 0) {
                        sum += near;
                        ++count;
                    }
                }
            value = count > 0 ? float(sum / count) : 0;
        }
}

bool set_filtered(OIIO::ImageBuf& dst, const OIIO::ImageSpec& spec, const std::vector<double>& rgb, bool clamp,
                  std::string& error)
{
    constexpr float kLargest = std::numeric_limits<float>::max();
    std::vector<float> pixels(rgb.size());
    for (size_t i = 0; i < rgb.size(); ++i) {
        // A mean does not exceed its largest value: a little beyond the largest float is rounding.
        const bool rounding = rgb[i] > kLargest && rgb[i] <= kLargest * (1 + 1e-6);
        pixels[i] = rounding ? kLargest : float(clamp ? std::max(0.0, rgb[i]) : rgb[i]);
        if (!std::isfinite(pixels[i])) {
            error = format("filtered light of {:g} is too large for a float", rgb[i]);
            return false;
        }
    }
    dst.reset(spec, OIIO::InitializePixels::No);
    return dst.set_pixels(dst.roi(), OIIO::TypeFloat, pixels.data());
}

void record_sanitized(OIIO::ImageSpec& spec, int64_t values)
{
    if (values)
        spec.attribute("vmlight:sanitized", int(std::min<int64_t>(values, std::numeric_limits<int>::max())));
}

} // namespace vmlight
