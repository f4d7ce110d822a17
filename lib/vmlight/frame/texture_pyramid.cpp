// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/texture_pyramid.h>

#include <vmlight/base/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vmlight {
namespace {

// The texels of the finer level that one of the coarser covers along an axis: at most three, because sizes are rounded
// down.
struct Span
{
    int first, count;
    std::array<float, 3> share;
};

std::vector<Span> spans(int fine, int coarse)
{
    std::vector<Span> result(static_cast<size_t>(coarse));
    for (int i = 0; i < coarse; ++i) {
        const double begin = double(i) * fine / coarse, end = double(i + 1) * fine / coarse;
        Span span { int(begin), 0, {} };
        for (int k = span.first; k < fine && k < end && span.count < 3; ++k)
            span.share[span.count++] = float((std::min(end, k + 1.0) - std::max(begin, double(k))) / (end - begin));
        result[i] = span;
    }
    return result;
}

// The two texels around a coordinate, and the share of the second.
struct Neighbours
{
    int low, high;
    float share;
};

Neighbours neighbours(double coordinate, int n, TextureWrap wrap)
{
    // Beyond this the texel is a matter of rounding; int must hold it.
    const double x = std::clamp(coordinate * n - 0.5, -1e9, 1e9), floor = std::floor(x);
    return { wrapped_texel(int64_t(floor), n, wrap), wrapped_texel(int64_t(floor) + 1, n, wrap), float(x - floor) };
}

} // namespace

TexturePyramid::TexturePyramid(int width, int height, int channels, const float* pixels, const float* weights,
                               TextureWrap wrap_s, TextureWrap wrap_t, int nthreads)
    : m_channels(channels)
    , m_wrap_s(wrap_s)
    , m_wrap_t(wrap_t)
{
    const size_t stride = size_t(channels) + 1;
    m_levels.push_back({ width, height, std::vector<float>(size_t(width) * size_t(height) * stride) });
    parallel_items(height, nthreads, [&](int64_t y, int) {
        for (int x = 0; x < width; ++x) {
            const size_t texel = size_t(y) * size_t(width) + size_t(x);
            const float weight = weights ? weights[texel] : 1;
            float* dst = &m_levels[0].texels[texel * stride];
            for (int c = 0; c < channels; ++c)
                dst[c] = weight > 0 ? pixels[texel * size_t(channels) + size_t(c)] * weight : 0;
            dst[channels] = weight;
        }
    });
    while (m_levels.back().width > 1 || m_levels.back().height > 1) {
        const Level& fine = m_levels.back();
        Level coarse { std::max(1, fine.width / 2), std::max(1, fine.height / 2), {} };
        coarse.texels.resize(size_t(coarse.width) * size_t(coarse.height) * stride);
        const std::vector<Span> across = spans(fine.width, coarse.width), down = spans(fine.height, coarse.height);
        parallel_items(coarse.height, nthreads, [&](int64_t y, int) {
            for (int x = 0; x < coarse.width; ++x) {
                float* dst = &coarse.texels[(size_t(y) * size_t(coarse.width) + size_t(x)) * stride];
                for (int j = 0; j < down[y].count; ++j)
                    for (int i = 0; i < across[x].count; ++i) {
                        const size_t row = size_t(down[y].first + j), column = size_t(across[x].first + i);
                        const float* src = &fine.texels[(row * size_t(fine.width) + column) * stride];
                        const float share = down[y].share[j] * across[x].share[i];
                        for (size_t c = 0; c < stride; ++c)
                            dst[c] += src[c] * share;
                    }
            }
        });
        m_levels.push_back(std::move(coarse));
    }
}

double TexturePyramid::level_of(const TextureFootprint& at) const
{
    const double w = m_levels[0].width, h = m_levels[0].height;
    const auto squared = [&](const Imath::V2d& d) { return Imath::V2d(d.x * w, d.y * h).length2(); };
    const double reach = std::max(squared(at.dx), squared(at.dy));
    return reach > 1 ? 0.5 * std::log2(reach) : 0;
}

// A number of channels that is known when compiling makes vectors of the sums.
template <int Channels>
void TexturePyramid::add_bilinear(float* sum, const Level& level, const Imath::V2d& st, float share) const
{
    const Neighbours s = neighbours(st.x, level.width, m_wrap_s), t = neighbours(st.y, level.height, m_wrap_t);
    const size_t stride = Channels ? size_t(Channels) + 1 : size_t(m_channels) + 1;
    const auto texel
        = [&](int x, int y) { return &level.texels[(size_t(y) * size_t(level.width) + size_t(x)) * stride]; };
    const float *a = texel(s.low, t.low), *b = texel(s.high, t.low), *c = texel(s.low, t.high),
                *d = texel(s.high, t.high);
    const float wa = share * (1 - s.share) * (1 - t.share), wb = share * s.share * (1 - t.share);
    const float wc = share * (1 - s.share) * t.share, wd = share * s.share * t.share;
    for (size_t i = 0; i < stride; ++i)
        sum[i] += a[i] * wa + b[i] * wb + c[i] * wc + d[i] * wd;
}

template <int Channels> void TexturePyramid::look_up(const TextureFootprint& at, float* dst) const
{
    constexpr int kMostChannels = 16;
    std::array<float, (Channels ? Channels : kMostChannels) + 1> sum {};
    const int last = int(m_levels.size()) - 1;
    const double lambda = std::min(level_of(at), double(last));
    int level = int(lambda);
    const float blend = float(lambda - level);
    add_bilinear<Channels>(sum.data(), m_levels[level], at.st, 1 - blend);
    if (blend > 0)
        add_bilinear<Channels>(sum.data(), m_levels[std::min(level + 1, last)], at.st, blend);
    while (!(sum[m_channels] > 0) && level < last)
        add_bilinear<Channels>(sum.data(), m_levels[++level], at.st, 1);
    const float scale = sum[m_channels] > 0 ? 1 / sum[m_channels] : 0;
    for (int c = 0; c < m_channels; ++c)
        dst[c] = sum[c] * scale;
}

void TexturePyramid::lookup(const TextureFootprint& at, float* dst) const
{
    if (m_channels == 3)
        look_up<3>(at, dst);
    else if (m_channels == 4)
        look_up<4>(at, dst);
    else
        look_up<0>(at, dst);
}

} // namespace vmlight
