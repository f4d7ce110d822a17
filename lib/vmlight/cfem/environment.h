// SPDX-License-Identifier: Apache-2.0
/// What the filters of an environment read: a lat-long map of light, row by row, so that a large one need not be held.
#pragma once

#include <vmlight/base/export.h>

#include <OpenImageIO/imagebuf.h>

#include <functional>
#include <string>

namespace vmlight {

class VMLIGHT_API Environment
{
public:
    /// Sets `pixels` to the floats of row `y` of the data window, all channels. From one thread; rows come in order,
    /// and may start again at the first. False, with the reason in `error`, if there is no such row to be had.
    using ReadPixels = std::function<bool(int y, float* pixels, std::string& error)>;

    /// An image, which must outlive this; it may be backed by an ImageCache. Implicit, since an image is one.
    Environment(const OIIO::ImageBuf& image); // NOLINT(google-explicit-constructor)
    /// An image that is read as the work goes down. `spec` says its size, channels and metadata.
    Environment(const OIIO::ImageSpec& spec, ReadPixels read);

    const OIIO::ImageSpec& spec() const;
    /// Why there is nothing to read, or "".
    std::string fault() const;

    /// Set `pixels` to the floats of `row`, one row of the display window and a range of channels: black outside the
    /// data window. False, with the reason in `error`, if it cannot be read.
    bool read(OIIO::ROI row, float* pixels, std::string& error) const;

private:
    const OIIO::ImageBuf* m_image = nullptr; // or:
    OIIO::ImageSpec m_spec;
    ReadPixels m_read;
};

} // namespace vmlight
