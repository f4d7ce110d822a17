// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/image/color.h>

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight {

/// The colour space that a recipe's light is written in: output_colorspace, or unchanged.
class OutputColor
{
public:
    /// @param space    "" leaves everything as it is
    /// @param config   OCIO config; "" means $OCIO
    /// @param light    its colorInteropID is the space of the light
    /// @returns false, with the reason in `error`, if the space is unknown, data or not linear.
    bool open(const std::string& space, const std::string& config, const OIIO::ImageSpec& light, std::string& error);

    /// Tag an image with the space.
    void tag(OIIO::ImageSpec& spec) const;
    /// Convert and tag a float image in memory; nthreads: 0 means OIIO's default.
    void apply(OIIO::ImageBuf& image, int nthreads) const;
    /// Convert RGB triples.
    void apply(float* rgb, size_t count) const;

    /// Whether pixels change.
    bool converts() const { return bool(m_convert); }
    /// Its interop id; "" if the light keeps its own.
    const std::string& space() const { return m_space; }
    /// ", written as SPACE", or "".
    std::string note() const { return m_space.empty() ? "" : ", written as " + m_space; }

private:
    ColorConversion m_convert;
    std::string m_space; // interop id; "" if nothing changes
};

} // namespace vmlight
