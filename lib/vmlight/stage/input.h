// SPDX-License-Identifier: Apache-2.0
/// The face that a stage shows to OIIO: a recipe, opened as an image. open() reads the recipe and describes the image;
/// the first tile that is asked for starts the work, of which all opens of the process share one copy.
/// Hosts call these functions from many threads and expect no exception: none leaves.
#pragma once

#include <vmlight/stage/pixel_source.h>

#include <OpenImageIO/imageio.h>

#include <string>

namespace vmlight {

class StageInput : public OIIO::ImageInput
{
public:
    /// @param stage    the format's name, which is its extension too: "vismap", "cfem" or "lightmap"
    explicit StageInput(const char* stage);
    ~StageInput() override;

    // The other overloads stay visible.
    using ImageInput::open;
    using ImageInput::read_native_scanline;
    using ImageInput::read_native_tile;
    using ImageInput::read_native_tiles;
    using ImageInput::valid_file;

    const char* format_name() const override;
    int supports(OIIO::string_view feature) const override;
    /// Goes by the extension alone, so that open() gets to say what is wrong with the rest.
    bool valid_file(const std::string& name) const override;
    /// Refuses names with another extension before all else: OIIO tries every reader on a file that its own reader
    /// cannot read, and holds a lock meanwhile.
    bool open(const std::string& name, OIIO::ImageSpec& spec) override;
    bool close() override;
    /// The levels of a stack are subimages; there are no mips.
    bool seek_subimage(int subimage, int miplevel) override;
    int current_subimage() const override { return m_subimage; }

    // Without the lock of OIIO's own: what open() found never changes.
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
    int m_subimage = 0; // the one that m_spec is of
    PixelSourcePointer m_source;
};

} // namespace vmlight
