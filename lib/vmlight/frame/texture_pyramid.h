// SPDX-License-Identifier: Apache-2.0
/// Images that frames look up, with all sizes down to one texel. Texels have weights: what no triangle covers has none,
/// so that it never bleeds into the picture, whatever the distance.
#pragma once

#include <vmlight/mesh/texture_wrap.h>

#include <Imath/ImathVec.h>

#include <vector>

namespace vmlight {

/// How far a lookup reaches: texture coordinates, and how they change from pixel to pixel.
struct TextureFootprint
{
    Imath::V2d st { 0 }, dx { 0 }, dy { 0 };
};

/// Level 0 is the image. A texel of the next level is the weighted mean of the texels that it covers, by their area in
/// it; its weight is the mean of theirs. Sizes are halved and rounded down. A lookup is trilinear:
///     lambda = log2(max(|(dx.s w, dx.t h)|, |(dy.s w, dy.t h)|)), at least 0,
/// and is interpolated between the levels floor(lambda) and floor(lambda) + 1, in each bilinearly between texel centres
/// (i + 0.5) / n; sums of weighted texels are divided by the sum of the weights at the end.
class TexturePyramid
{
public:
    struct Level
    {
        int width, height;
        /// For each texel its channels times its weight, then the weight.
        std::vector<float> texels;
    };

    TexturePyramid() = default;
    /// @param channels at most 16
    /// @param pixels   `channels` floats a texel, row 0 at t = 0
    /// @param weights  one a texel, in [0, 1]; nullptr: 1 everywhere
    TexturePyramid(int width, int height, int channels, const float* pixels, const float* weights,
                   TextureWrap wrap_s = TextureWrap::clamp, TextureWrap wrap_t = TextureWrap::clamp, int nthreads = 0);

    bool is_empty() const { return m_levels.empty(); }
    int channels() const { return m_channels; }
    TextureWrap wrap_s() const { return m_wrap_s; }
    TextureWrap wrap_t() const { return m_wrap_t; }
    const std::vector<Level>& levels() const { return m_levels; }

    /// lambda of a lookup, without an upper limit.
    double level_of(const TextureFootprint& at) const;
    /// Set `dst` to the channels at a point. Where nothing within reach has weight, coarser levels are looked up until
    /// something has; 0 if nothing has.
    void lookup(const TextureFootprint& at, float* dst) const;

private:
    template <int Channels> void add_bilinear(float* sum, const Level& level, const Imath::V2d& st, float share) const;
    template <int Channels> void look_up(const TextureFootprint& at, float* dst) const;

    int m_channels = 0;
    TextureWrap m_wrap_s = TextureWrap::clamp, m_wrap_t = TextureWrap::clamp;
    std::vector<Level> m_levels;
};

} // namespace vmlight
