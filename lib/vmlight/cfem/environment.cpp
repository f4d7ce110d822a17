// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cfem/environment.h>

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace vmlight {

Environment::Environment(const OIIO::ImageBuf& image)
    : m_image(&image)
{
}

Environment::Environment(const OIIO::ImageSpec& spec, ReadPixels read)
    : m_spec(spec)
    , m_read(std::move(read))
{
}

const OIIO::ImageSpec& Environment::spec() const
{
    return m_image ? m_image->spec() : m_spec;
}

std::string Environment::fault() const
{
    const OIIO::ImageSpec& own = spec(); // opens a file that was only named
    const bool there = (!m_image || m_image->initialized()) && own.width > 0 && own.height > 0;
    if (!there)
        return m_image && m_image->has_error() ? oiio::error_line(*m_image) : "environment has no pixels";
    if (own.deep || own.depth > 1)
        return "environment is a deep image or a volume, not a lat-long map";
    if (OIIO::Strutil::istarts_with(own.get_string_attribute("textureformat"), "CubeFace"))
        return "environment is a cube map, not a lat-long map";
    return "";
}

bool Environment::read(OIIO::ROI row, float* pixels, std::string& error) const
{
    if (m_image) {
        const bool read = m_image->get_pixels(row, OIIO::TypeFloat, pixels);
        if (read && !m_image->has_error())
            return true;
        const std::string reason = oiio::error_line(*m_image);
        error = reason.empty() ? format("cannot read row {} of the environment", row.ybegin) : reason;
        return false;
    }
    const int channels = row.nchannels(), all = m_spec.nchannels;
    std::fill_n(pixels, size_t(row.width()) * channels, 0.0f);
    if (row.ybegin < m_spec.y || row.ybegin >= m_spec.y + m_spec.height)
        return true;
    std::vector<float> stored(size_t(m_spec.width) * all);
    if (!m_read(row.ybegin, stored.data(), error))
        return false;
    const int begin = std::max(row.xbegin, m_spec.x), end = std::min(row.xend, m_spec.x + m_spec.width);
    for (int x = begin; x < end; ++x)
        std::copy_n(&stored[size_t(x - m_spec.x) * all + row.chbegin], channels,
                    pixels + size_t(x - row.xbegin) * channels);
    return true;
}

} // namespace vmlight
