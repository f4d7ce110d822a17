// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/output_color.h>

#include <vmlight/image/color_transform.h>

#include <utility>

namespace vmlight {

bool OutputColor::open(const std::string& space, const std::string& config, const OIIO::ImageSpec& light,
                       std::string& error)
{
    if (space.empty())
        return true;
    ColorTransform transform;
    ColorSettings settings;
    settings.config = config;
    if (!find_output_transform(transform, light.get_string_attribute("colorInteropID"), space, settings, error))
        return false;
    m_convert = std::move(transform.convert);
    m_space = transform.space;
    return true;
}

void OutputColor::tag(OIIO::ImageSpec& spec) const
{
    if (!m_space.empty())
        tag_scene_linear(spec, m_space);
}

void OutputColor::apply(OIIO::ImageBuf& image, int nthreads) const
{
    if (!m_space.empty())
        convert_color(image, m_convert, m_space, nthreads);
}

void OutputColor::apply(float* rgb, size_t count) const
{
    if (m_convert)
        m_convert(rgb, int(count));
}

} // namespace vmlight
