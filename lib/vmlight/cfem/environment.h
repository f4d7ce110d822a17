// SPDX-License-Identifier: Apache-2.0
/// The input of the environment filters: a lat-long map of light, read row by row, so that a large one need not fit in
/// memory.
#pragma once

#include <vmlight/base/export.h>

#include <OpenImageIO/imagebuf.h>

#include <functional>
#include <string>

namespace vmlight {

class VMLIGHT_API Environment
{
public:
    /// Sets `pixels` to the floats of row `y` of the data window, all channels. Called from one thread, for rows in
    /// order, possibly several times from the first. Returns false, with the reason in `error`, if the row cannot be
    /// read.
    using ReadPixels = std::function<bool(int y, float* pixels, std::string& error)>;

    /// An image, which must outlive this and may be backed by an ImageCache. Implicit: every lat-long image is an
    /// environment.
    Environment(const OIIO::ImageBuf& image); // NOLINT(google-explicit-constructor)
    /// Rows from a callback; `spec` has the size, channels and metadata.
    Environment(const OIIO::ImageSpec& spec, ReadPixels read);

    const OIIO::ImageSpec& spec() const;
    /// Why it cannot be read as a lat-long map, or "".
    std::string fault() const;

    /// Set `pixels` to the floats of `row`, one row of the display window and a range of channels; black outside the
    /// data window. Returns false, with the reason in `error`, if it cannot be read.
    bool read(OIIO::ROI row, float* pixels, std::string& error) const;

private:
    const OIIO::ImageBuf* m_image = nullptr; // or:
    OIIO::ImageSpec m_spec;
    ReadPixels m_read;
};

} // namespace vmlight
