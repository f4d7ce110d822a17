// SPDX-License-Identifier: Apache-2.0
/// Whole pictures, antialiased: one pass for each sample of the pixels, the same samples as those of vmframes.
#pragma once

#include "renderer.h"

#include <vmlight/frame/render.h>

#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight::view {

/// Adds up the samples of a picture, one after the other, so that a window may show it at any time.
class PictureSum
{
public:
    /// Start anew, for pictures of `width` x `height` pixels with `spp` samples.
    void start(int width, int height, int spp, const std::string& filter);
    bool is_complete() const { return m_next == m_samples.size(); }
    int taken() const { return int(m_next); }
    /// Add the next sample of what `params` describe, whose size, sample, offset and footprint are set here.
    void add(const Renderer& renderer, PictureParams params);
    /// The mean of the samples so far.
    const Texture& mean() const { return m_samples.size() == 1 ? m_sample.color() : m_mean.color(); }
    const Framebuffer& mean_framebuffer() const { return m_samples.size() == 1 ? m_sample : m_mean; }

private:
    Framebuffer m_sample, m_sum, m_mean;
    std::vector<PixelSample> m_samples;
    size_t m_next = 0;
};

/// Render a picture, R, G, B times alpha and A, scene-linear, rows from the top, right at every edge. False, with the
/// reason in `error`, if the driver finds a wrong call.
bool render_picture(OIIO::ImageBuf& dst, Renderer& renderer, const PictureParams& params, const RenderParams& render,
                    std::string& error);

/// The pixels of a framebuffer, rows from the top.
OIIO::ImageBuf read_image_of(const Framebuffer& framebuffer);

} // namespace vmlight::view
