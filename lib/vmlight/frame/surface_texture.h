// SPDX-License-Identifier: Apache-2.0
/// What frames look up on the surface of an object, by its UVs: images in memory, or any file that OIIO's texture
/// system opens.
#pragma once

#include <vmlight/frame/texture_pyramid.h>

#include <OpenImageIO/texture.h>
#include <OpenImageIO/ustring.h>

#include <map>
#include <memory>
#include <string>

namespace vmlight {

/// Looked up from any number of threads.
class SurfaceTexture
{
public:
    virtual ~SurfaceTexture() = default;

    virtual int channels() const = 0;
    /// Set `dst` to the channels at uv `at` (v up, UDIM tiles as integer parts). Returns false, with the reason in
    /// `error`, if pixels cannot be read.
    virtual bool lookup(const TextureFootprint& at, float* dst, std::string& error) const = 0;
};

/// A pyramid for each UDIM tile. 0 in tiles without one.
class TileTexture : public SurfaceTexture
{
public:
    explicit TileTexture(int channels)
        : m_channels(channels)
    {
    }
    /// Set the image of a tile, replacing an earlier one. Not while lookups run.
    void set(int udim, TexturePyramid image) { m_tiles[udim] = std::move(image); }
    const TexturePyramid* tile(int udim) const;

    int channels() const override { return m_channels; }
    bool lookup(const TextureFootprint& at, float* dst, std::string& error) const override;

private:
    const int m_channels;
    std::map<int, TexturePyramid> m_tiles;
};

/// Colour of a file, or of a recipe of one of the readers, through OIIO's TextureSystem with ray differentials:
/// trilinear, between texels bilinear; what is beyond the edge is the edge. `<UDIM>` in the name stands for the tile;
/// tiles without a file are black.
class FileTexture : public SurfaceTexture
{
public:
    /// False, with the reason in `error`, if it cannot be opened, has no colour, or is of another stage than a
    /// lightmap. A single channel serves as all.
    bool open(const std::string& name, std::string& error);
    /// Whether its pixels are integers, as those of albedo textures are.
    bool has_integers() const { return m_is_integer; }

    int channels() const override { return 3; }
    bool lookup(const TextureFootprint& at, float* dst, std::string& error) const override;

private:
    struct Tile
    {
        OIIO::ustring file;
        bool is_gray = false;
    };
    bool open_tile(int udim, const std::string& file, std::string& error);

    // By UDIM tile; the only one of a file without tiles is 0. OIIO's own search for tiles takes v as it is and rows
    // from the top, which turns each tile upside down.
    std::map<int, Tile> m_tiles;
    bool m_is_integer = false;
    std::shared_ptr<OIIO::TextureSystem> m_system;
};

} // namespace vmlight
