// SPDX-License-Identifier: Apache-2.0
#include "picture.h"

#include "../gl/fault.h"

#include <algorithm>
#include <cmath>

namespace vmlight::view {

void PictureSum::start(int width, int height, int spp, const std::string& filter)
{
    m_samples = pixel_samples(spp, filter);
    m_next = 0;
    if (m_sample.width() != width || m_sample.height() != height) {
        m_sample = Framebuffer(width, height, GL_RGBA32F, true);
        m_sum = Framebuffer();
        m_mean = Framebuffer();
    }
    if (spp > 1 && !m_sum) {
        m_sum = Framebuffer(width, height, GL_RGBA32F, false);
        m_mean = Framebuffer(width, height, GL_RGBA32F, false);
    }
}

void PictureSum::add(const Renderer& renderer, PictureParams params)
{
    const PixelSample& sample = m_samples[m_next];
    params.view.width = m_sample.width();
    params.view.height = m_sample.height();
    params.view.sample = int(m_next);
    params.view.offset = { sample.x, sample.y };
    params.view.footprint = 1 / std::sqrt(double(m_samples.size()));
    renderer.draw(params, m_sample);
    ++m_next;
    if (m_samples.size() == 1)
        return;
    if (m_next == 1) {
        m_sum.bind();
        glClearColor(0, 0, 0, 0);
        glClear(GL_COLOR_BUFFER_BIT);
    }
    renderer.accumulate(m_sum, m_sample.color(), 1);
    m_mean.bind();
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT);
    renderer.accumulate(m_mean, m_sum.color(), 1.0 / double(m_next));
}

OIIO::ImageBuf read_image_of(const Framebuffer& framebuffer)
{
    const int width = framebuffer.width(), height = framebuffer.height();
    OIIO::ImageSpec spec(width, height, 4, OIIO::TypeFloat);
    spec.channelnames = { "R", "G", "B", "A" };
    spec.alpha_channel = 3;
    OIIO::ImageBuf image(spec);
    auto* pixels = static_cast<float*>(image.localpixels());
    framebuffer.read(pixels);
    const size_t row = 4 * size_t(width);
    for (int y = 0; y < height / 2; ++y)
        std::swap_ranges(pixels + size_t(y) * row, pixels + size_t(y + 1) * row, pixels + size_t(height - 1 - y) * row);
    return image;
}

bool render_picture(OIIO::ImageBuf& dst, Renderer& renderer, const PictureParams& params, const RenderParams& render,
                    std::string& error)
{
    PictureSum sum;
    sum.start(render.size.width, render.size.height, render.spp, render.filter);
    View view = params.view;
    view.width = render.size.width;
    view.height = render.size.height;
    renderer.prepare_exact(view);
    while (!sum.is_complete())
        sum.add(renderer, params);
    renderer.reset_exact();
    dst = read_image_of(sum.mean_framebuffer());
    error = gl_fault();
    return error.empty();
}

} // namespace vmlight::view
