// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/alpha_texture.h>

#include <OpenImageIO/hash.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace vmlight {
namespace {

// Beyond this the texel is a matter of rounding; whole numbers must hold it.
constexpr double kFarthestTexel = 1e9;
// So many are looked at one by one, sooner than by blocks.
constexpr int64_t kFewTexels = 256;

// Of texels, never outside of what it mixes: without the limits rounding would lead past the greater one.
double mixed(double a, double b, double share)
{
    const double x = a + (b - a) * share;
    return a < b ? std::min(std::max(x, a), b) : std::min(std::max(x, b), a);
}

} // namespace

AlphaTexture::AlphaTexture(int width, int height, std::vector<float> texels, TextureWrap wrap_s, TextureWrap wrap_t,
                           bool is_nearest)
    : m_width(width)
    , m_height(height)
    , m_texels(std::move(texels))
    , m_wrap_s(wrap_s)
    , m_wrap_t(wrap_t)
    , m_is_nearest(is_nearest)
{
    for (float& alpha : m_texels) {
        alpha = alpha < 0 ? 0 : alpha > 1 || std::isnan(alpha) ? 1 : alpha;
        // Denormals: whether they count depends on the mode of the processor, which the tracer changes.
        if (alpha < std::numeric_limits<float>::min())
            alpha = 0;
    }
    build_levels();
}

void AlphaTexture::build_levels()
{
    int width = m_width, height = m_height;
    while (width > 1 || height > 1) {
        Level level { (width + 1) / 2, (height + 1) / 2, {}, {} };
        level.low.reserve(size_t(level.width) * size_t(level.height));
        level.high.reserve(level.low.capacity());
        const int finer = int(m_levels.size());
        for (int y = 0; y < level.height; ++y)
            for (int x = 0; x < level.width; ++x) {
                AlphaRange range;
                for (int j = 2 * y; j < std::min(2 * y + 2, height); ++j)
                    for (int i = 2 * x; i < std::min(2 * x + 2, width); ++i) {
                        const AlphaRange part = block(finer, i, j);
                        range.add(part.low, part.high);
                    }
                level.low.push_back(float(range.low));
                level.high.push_back(float(range.high));
            }
        width = level.width;
        height = level.height;
        m_levels.push_back(std::move(level));
    }
}

double AlphaTexture::coordinate(double st, int n) const
{
    return std::floor(std::clamp(st * n - (m_is_nearest ? 0.0 : 0.5), -kFarthestTexel, kFarthestTexel));
}

bool AlphaTexture::operator==(const AlphaTexture& other) const
{
    return m_width == other.m_width && m_height == other.m_height && m_wrap_s == other.m_wrap_s
        && m_wrap_t == other.m_wrap_t && m_is_nearest == other.m_is_nearest && m_texels == other.m_texels;
}

uint64_t AlphaTexture::hash() const
{
    const std::array<uint64_t, 6> parts { uint64_t(m_width),
                                          uint64_t(m_height),
                                          uint64_t(m_wrap_s),
                                          uint64_t(m_wrap_t),
                                          uint64_t(m_is_nearest),
                                          OIIO::farmhash::Fingerprint64(reinterpret_cast<const char*>(m_texels.data()),
                                                                        m_texels.size() * sizeof(float)) };
    return OIIO::farmhash::Fingerprint64(reinterpret_cast<const char*>(parts.data()), sizeof(parts));
}

double AlphaTexture::lookup(const Imath::V2d& st) const
{
    const double s = coordinate(st.x, m_width), t = coordinate(st.y, m_height);
    const int x = wrapped_texel(int64_t(s), m_width, m_wrap_s), y = wrapped_texel(int64_t(t), m_height, m_wrap_t);
    if (m_is_nearest)
        return double(texel(x, y));
    const int right = wrapped_texel(int64_t(s) + 1, m_width, m_wrap_s);
    const int below = wrapped_texel(int64_t(t) + 1, m_height, m_wrap_t);
    const double across = std::clamp(st.x * m_width - 0.5 - s, 0.0, 1.0);
    const double down = std::clamp(st.y * m_height - 0.5 - t, 0.0, 1.0);
    return mixed(mixed(double(texel(x, y)), double(texel(right, y)), across),
                 mixed(double(texel(x, below)), double(texel(right, below)), across), down);
}

AlphaTexture::Spans AlphaTexture::spans(double low, double high, int n, TextureWrap wrap) const
{
    const int64_t first = int64_t(coordinate(low, n)), last = int64_t(coordinate(high, n)) + (m_is_nearest ? 0 : 1);
    Spans result;
    if (wrap == TextureWrap::clamp) {
        result.parts[result.count++] = { wrapped_texel(first, n, wrap), wrapped_texel(last, n, wrap) };
        return result;
    }
    const int64_t period = wrap == TextureWrap::mirror ? 2 * int64_t(n) : n;
    if (last - first + 1 >= period) {
        result.parts[result.count++] = { 0, n - 1 };
        return result;
    }
    // Image by image of the endless row: at most three of a row, since together they are shorter than two.
    const int64_t start = first - (first % period + period) % period;
    for (int64_t image = start; image <= last; image += n) {
        if (image + n <= first)
            continue;
        const int64_t a = std::max(first, image), b = std::min(last, image + n - 1);
        const int x = wrapped_texel(a, n, wrap), y = wrapped_texel(b, n, wrap);
        result.parts[result.count++] = { std::min(x, y), std::max(x, y) };
    }
    return result;
}

AlphaRange AlphaTexture::block(int level, int x, int y) const
{
    if (level == 0)
        return { double(texel(x, y)), double(texel(x, y)) };
    const Level& blocks = m_levels[size_t(level) - 1];
    const size_t at = size_t(y) * size_t(blocks.width) + size_t(x);
    return { double(blocks.low[at]), double(blocks.high[at]) };
}

void AlphaTexture::add(AlphaRange& dst, int level, int x, int y, const Span& across, const Span& down) const
{
    const int64_t side = int64_t(1) << level, left = x * side, top = y * side;
    if (left > across.last || left + side <= across.first || top > down.last || top + side <= down.first)
        return;
    const AlphaRange all = block(level, x, y);
    if (all.low >= dst.low && all.high <= dst.high)
        return;
    const int64_t right = std::min<int64_t>(left + side, m_width), bottom = std::min<int64_t>(top + side, m_height);
    if (level == 0 || all.low == all.high
        || (left >= across.first && right - 1 <= across.last && top >= down.first && bottom - 1 <= down.last)) {
        dst.add(all.low, all.high);
        return;
    }
    const int width = level == 1 ? m_width : m_levels[size_t(level) - 2].width;
    const int height = level == 1 ? m_height : m_levels[size_t(level) - 2].height;
    for (int j = 2 * y; j < std::min(2 * y + 2, height); ++j)
        for (int i = 2 * x; i < std::min(2 * x + 2, width); ++i)
            add(dst, level - 1, i, j, across, down);
}

AlphaRange AlphaTexture::range(const Imath::V2d& low, const Imath::V2d& high) const
{
    const Spans across = spans(low.x, high.x, m_width, m_wrap_s), down = spans(low.y, high.y, m_height, m_wrap_t);
    AlphaRange result;
    for (int j = 0; j < down.count; ++j)
        for (int i = 0; i < across.count; ++i) {
            const Span &x = across.parts[i], &y = down.parts[j];
            if (int64_t(x.last - x.first + 1) * (y.last - y.first + 1) <= kFewTexels) {
                add_texels(result, x, y);
                continue;
            }
            int level = 0;
            while (level < int(m_levels.size()) && (1 << level) <= std::max(x.last - x.first, y.last - y.first))
                ++level;
            for (int row = y.first >> level; row <= y.last >> level; ++row)
                for (int column = x.first >> level; column <= x.last >> level; ++column)
                    add(result, level, column, row, x, y);
        }
    return result;
}

void AlphaTexture::add_texels(AlphaRange& dst, const Span& across, const Span& down) const
{
    // Floats from 0 on are in the order of their bits, and compilers make vectors of whole numbers' least and greatest.
    constexpr int kOne = 0x3f800000;
    int low = kOne, high = 0;
    for (int y = down.first; y <= down.last; ++y) {
        const float* row = &m_texels[size_t(y) * size_t(m_width)];
        for (int x = across.first; x <= across.last; ++x) {
            int bits;
            std::memcpy(&bits, row + x, sizeof(bits));
            low = std::min(low, bits);
            high = std::max(high, bits);
        }
    }
    float least, greatest;
    std::memcpy(&least, &low, sizeof(least));
    std::memcpy(&greatest, &high, sizeof(greatest));
    dst.add(double(least), double(greatest));
}

AlphaRange AlphaTexture::range() const
{
    return block(int(m_levels.size()), 0, 0);
}

size_t AlphaTexture::bytes() const
{
    size_t count = m_texels.size();
    for (const Level& level : m_levels)
        count += level.low.size() + level.high.size();
    return count * sizeof(float);
}

} // namespace vmlight
