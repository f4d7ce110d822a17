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
    /// Images in it: several if it is a stack of CFEM.
    virtual int subimages() const { return 1; }
    virtual const OIIO::ImageSpec& spec_of(int /*subimage*/) const { return m_spec; }
    /// All that the pixels depend on: parameters, and name, size and time of each file. Equal keys, equal pixels.
    const std::string& key() const { return m_key; }

    /// Set `dst` to the float pixels of `roi`, all channels, rows without padding; `roi` lies in the data window. Any
    /// thread. False, with the reason in `error`, if they cannot be made.
    virtual bool read(OIIO::ROI roi, float* dst, std::string& error) = 0;

    /// The same for any image of it.
    virtual bool read_of(int subimage, OIIO::ROI roi, float* dst, std::string& error)
    {
        if (subimage == 0)
            return read(roi, dst, error);
        error = "no such image";
        return false;
    }

    /// Make the images of `range` whole: float, the same pixels bit for bit as read_of() gives, with all metadata, also
    /// what is only known once they are made (samples, hash of the mesh). By all threads, and the source keeps nothing
    /// of them: not to be called under a lock that a task of OIIO's thread pool may want.
    ///
    /// @param options  whose chain ends with the recipe of this source, if it is one
    /// @returns false, with the reason and its place in `error`; `dst` then holds nothing of use
    virtual bool make(std::vector<OIIO::ImageBuf>& dst, ImageRange range, const MakeOptions& options,
                      std::string& error)
        = 0;

    /// Whether what the pixels are made from could not be had, or is no longer as it was, so that another open should
    /// try anew.
    virtual bool failed() const { return false; }
    /// Memory held for later reads, about.
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
