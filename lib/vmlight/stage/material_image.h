// SPDX-License-Identifier: Apache-2.0
/// The images that materials name: files, ranges of files (GLB), or whole files in text.
#pragma once

#include <vmlight/mesh/material.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imageio.h>

#include <memory>
#include <string>

namespace vmlight {

/// An open image; one thread at a time.
class MaterialImage
{
public:
    /// Open the image and read its header; colour comes as stored, not multiplied by alpha. False, with the reason and
    /// the path in `error`, if it cannot be read, or its header is not believed.
    bool open(const MaterialTexture& texture, std::string& error);

    /// After open(): as stored.
    const OIIO::ImageSpec& spec() const { return m_in->spec(); }
    /// Read channels first ... end - 1 of all pixels, interleaved, as float. False, with the reason and the path in
    /// `error`, if pixels cannot be read.
    bool read(int first, int end, float* dst, std::string& error);

    /// Read all of an image, its first channels up to `channels`, as float, in memory; `stored` is nullptr, or set to
    /// the format in the file. False, with the reason in `error`, as open(), or if it is no flat image, or memory is
    /// short.
    static bool read_all(OIIO::ImageBuf& dst, const MaterialTexture& texture, int channels, std::string& error,
                         OIIO::TypeDesc* stored = nullptr);

private:
    bool open_embedded(const MaterialTexture& texture, std::string& error);

    std::string m_path, m_bytes;
    std::unique_ptr<OIIO::Filesystem::IOMemReader> m_memory;
    std::unique_ptr<OIIO::ImageInput> m_in; // reads m_memory, so goes first
};

} // namespace vmlight
