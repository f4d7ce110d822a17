// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/one_color_light.h>

#include <vmlight/lightmap/brightest_light.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace vmlight {
namespace {

class OneColorShader : public ModelShader
{
public:
    OneColorShader(const std::array<float, 3>& color, const ShadingModel& model, float gain,
                   std::unique_ptr<ModelShader> forced)
        : m_color(color)
        , m_gain(gain)
        , m_channels(model.channels.size())
        , m_unread(size_t(model.entry->unread))
        , m_first_whole(m_channels - size_t(model.entry->whole_numbers))
        , m_is_held(model.light != ModelLight::cfem)
        , m_forced(std::move(forced))
    {
    }

    bool shade(TexelLayout layout, const float* vismap, size_t texels, float* rgb) const override
    {
        if (m_forced)
            m_forced->shade(layout, vismap, texels, rgb);
        const bool last = layout == TexelLayout::visibility_last;
        const size_t at = last ? 3 : 0, first = last ? 0 : 1 + m_unread, end = last ? 3 : m_first_whole;
        bool sound = true;
        for (size_t i = 0; i < texels; ++i, vismap += m_channels, rgb += 3) {
            float sum = 0; // of what the model would read
            for (size_t k = first; k < end; ++k)
                sum += vismap[k];
            sound &= sum - sum == 0 && std::abs(vismap[at]) <= kLargestVisibility;
            for (size_t k = m_first_whole; k < m_channels; ++k)
                sound &= vismap[k] >= 0 && vismap[k] < 0x1p24f && vismap[k] == std::floor(vismap[k]);
            const float light = std::max(vismap[at] * m_gain, 0.0f);
            for (size_t c = 0; c < 3; ++c) {
                const float seen = light * m_color[c];
                sound &= std::isfinite(seen);
                rgb[c] = m_is_held ? held_to(m_color[c], m_gain, seen) : seen;
            }
        }
        return sound;
    }

private:
    std::array<float, 3> m_color;
    float m_gain;
    size_t m_channels, m_unread, m_first_whole;
    bool m_is_held;
    std::unique_ptr<ModelShader> m_forced;
};

} // namespace

std::unique_ptr<ModelShader> one_color_shader(const std::array<float, 3>& color, const ShadingModel& model, float gain,
                                              std::unique_ptr<ModelShader> forced)
{
    return std::make_unique<OneColorShader>(color, model, gain, std::move(forced));
}

} // namespace vmlight
