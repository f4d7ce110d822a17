// SPDX-License-Identifier: Apache-2.0
/// The one path from a name to pixels: a file, or a recipe whose pixels are made on demand. Opening a source
/// (open_source.h) resolves UDIM, checks the recipe, opens its inputs, which are sources too, chooses the model and the
/// colour conversion, and describes the image. Then it is read by the tile, as OIIO's hosts do, or made whole, as the
/// executables do.
#pragma once

#include <vmlight/stage/make_options.h>

#include <OpenImageIO/imagebuf.h>

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace vmlight {

/// Which images of a source: `count` from `first` on.
struct ImageRange
{
    int first = 0, count = 1;
};

/// An image that is read by region, or made whole.
class PixelSource
{
public:
    virtual ~PixelSource() = default;

    /// Size, channels and metadata, known before any pixel is.
    const OIIO::ImageSpec& spec() const { return m_spec; }
    /// Number of images: several for a CFEM stack.
    virtual int subimages() const { return 1; }
    virtual const OIIO::ImageSpec& spec_of(int /*subimage*/) const { return m_spec; }
    /// Everything that the pixels depend on: parameters, and name, size and time of each file. Equal keys, equal
    /// pixels.
    const std::string& key() const { return m_key; }

    /// Set `dst` to the float pixels of `roi`, which is within the data window: all channels, rows without padding. Any
    /// thread. False, with the reason in `error`, on failure.
    virtual bool read(OIIO::ROI roi, float* dst, std::string& error) = 0;

    /// The same for image number `subimage`.
    virtual bool read_of(int subimage, OIIO::ROI roi, float* dst, std::string& error)
    {
        if (subimage == 0)
            return read(roi, dst, error);
        error = "no such image";
        return false;
    }

    /// Make the images of `range` whole, on all threads: float, bit for bit the pixels of read_of(), with all metadata,
    /// including what is known only afterwards (samples, mesh hash). The source keeps no copy. Do not call it while
    /// holding a lock that a task of OIIO's thread pool may want.
    ///
    /// @param options  its chain ends with this source's recipe, if that has a file
    /// @returns false, with the location and reason in `error`; `dst` is then unspecified.
    virtual bool make(std::vector<OIIO::ImageBuf>& dst, ImageRange range, const MakeOptions& options,
                      std::string& error)
        = 0;

    /// Whether making the pixels failed or an input has changed since, so that the next open should start over.
    virtual bool failed() const { return false; }
    /// Approximate memory held for later reads, in bytes.
    virtual size_t bytes() const { return 0; }

protected:
    explicit PixelSource(std::string key)
        : m_key(std::move(key))
    {
    }
    OIIO::ImageSpec m_spec;

private:
    const std::string m_key;
};
using PixelSourcePointer = std::shared_ptr<PixelSource>;

} // namespace vmlight
