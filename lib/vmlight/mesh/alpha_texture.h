// SPDX-License-Identifier: Apache-2.0
/// One channel of an image in memory, looked up for opacity: a point exactly, a box by the least and greatest value in
/// it. The two never disagree, to the bit.
#pragma once

#include <vmlight/mesh/texture_wrap.h>

#include <Imath/ImathVec.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vmlight {

/// No value: `low` above `high`.
struct AlphaRange
{
    double low = 2, high = -1;

    void add(double least, double greatest)
    {
        low = least < low ? least : low;
        high = greatest > high ? greatest : high;
    }
};

class AlphaTexture
{
public:
    /// @param texels   rows from the top, where t = 0. NaN becomes 1, so that what is broken is seen; others are
    ///                 clamped to [0, 1]
    AlphaTexture(int width, int height, std::vector<float> texels, TextureWrap wrap_s, TextureWrap wrap_t,
                 bool is_nearest = false);

    /// The same values at all points.
    bool operator==(const AlphaTexture& other) const;
    /// Equal for equal textures, the same on every little-endian machine.
    uint64_t hash() const;

    /// The value at a point, between texel centres (i + 0.5) / n bilinearly, unless `is_nearest`. Texel coordinates
    /// beyond 1e9 are those of 1e9. Not checked: that `st` is finite.
    double lookup(const Imath::V2d& st) const;
    /// The least and greatest of all texels that lookups in the box touch: no lookup there is outside of it.
    AlphaRange range(const Imath::V2d& low, const Imath::V2d& high) const;
    /// Of all texels.
    AlphaRange range() const;

    int width() const { return m_width; }
    int height() const { return m_height; }
    size_t bytes() const;

private:
    /// Texels first ... last.
    struct Span
    {
        int first, last;
    };
    /// Parts of a row: a mirrored row may be entered in the middle and left in its third image.
    struct Spans
    {
        Span parts[3];
        int count = 0;
    };
    /// The least and greatest texel of blocks of 2^k x 2^k, for level k from 1; at the end of a row there may be less.
    struct Level
    {
        int width, height;
        std::vector<float> low, high;
    };

    float texel(int x, int y) const { return m_texels[size_t(y) * size_t(m_width) + size_t(x)]; }
    double coordinate(double st, int n) const;
    Spans spans(double low, double high, int n, TextureWrap wrap) const;
    AlphaRange block(int level, int x, int y) const;
    void add(AlphaRange& dst, int level, int x, int y, const Span& across, const Span& down) const;
    void add_texels(AlphaRange& dst, const Span& across, const Span& down) const;
    void build_levels();

    int m_width, m_height;
    std::vector<float> m_texels;
    TextureWrap m_wrap_s, m_wrap_t;
    bool m_is_nearest;
    std::vector<Level> m_levels;
};

} // namespace vmlight
