// SPDX-License-Identifier: Apache-2.0
/// A stage as an OIIO reader: a recipe opens as an image. open() reads the recipe and describes the image; reading the
/// first tile starts the work, and everything that opens the same recipe in this process shares the result.
/// Hosts call these functions from many threads. No exception leaves them.
#pragma once

#include <vmlight/stage/pixel_source.h>

#include <OpenImageIO/imageio.h>

#include <string>

namespace vmlight {

class StageInput : public OIIO::ImageInput
{
public:
    /// @param stage    name of the format, and its extension: "vismap", "cfem" or "lightmap"
    explicit StageInput(const char* stage);
    ~StageInput() override;

    // Keep the other overloads visible.
    using ImageInput::open;
    using ImageInput::read_native_scanline;
    using ImageInput::read_native_tile;
    using ImageInput::read_native_tiles;
    using ImageInput::valid_file;

    const char* format_name() const override;
    int supports(OIIO::string_view feature) const override;
    /// Looks at the extension only, so that open() can report what is wrong with the file.
    bool valid_file(const std::string& name) const override;
    /// Refuses other extensions before doing anything else: OIIO tries every reader on a file that its own reader
    /// fails on, and holds a lock while it does.
    bool open(const std::string& name, OIIO::ImageSpec& spec) override;
    bool close() override;
    /// The images of a stack are subimages. There are no MIP levels.
    bool seek_subimage(int subimage, int miplevel) override;
    int current_subimage() const override { return m_subimage; }

    // Without OIIO's lock: what open() found never changes.
    OIIO::ImageSpec spec(int subimage, int miplevel = 0) override;
    OIIO::ImageSpec spec_dimensions(int subimage, int miplevel = 0) override;

    bool read_native_scanline(int subimage, int miplevel, int y, int z, void* data) override;
    bool read_native_tile(int subimage, int miplevel, int x, int y, int z, void* data) override;
    bool read_native_tiles(int subimage, int miplevel, int xbegin, int xend, int ybegin, int yend, int zbegin, int zend,
                           void* data) override;
    bool read_native_tiles(int subimage, int miplevel, int xbegin, int xend, int ybegin, int yend, int zbegin, int zend,
                           int chbegin, int chend, void* data) override;

private:
    template <class Work> bool guarded(Work&& work);

    bool has(int subimage, int miplevel) const;

    const char* const m_stage;
    int m_subimage = 0; // m_spec describes this one
    PixelSourcePointer m_source;
};

} // namespace vmlight
