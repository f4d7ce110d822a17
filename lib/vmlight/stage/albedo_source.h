// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/base/cache.h>
#include <vmlight/image/color.h>
#include <vmlight/lightmap/input.h>
#include <vmlight/stage/pixel_source.h>
#include <vmlight/stage/recipe/recipe.h>

#include <OpenImageIO/imagebuf.h>

#include <atomic>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// The albedo of lightmaps of one size, in linear light: converted and resized once, whole, on first use, whatever the
/// rotations and exposures that want it.
class AlbedoSource : public PixelSource
{
public:
    /// @param image    the texture
    /// @param config   stamp_config() of the recipe's colorconfig
    /// @param size     the pixels of the visibility map
    /// @returns nullptr, with the reason in `error`, if the texture has no colour
    static std::shared_ptr<AlbedoSource> open(const LightmapRecipe& recipe, PixelSourcePointer image,
                                              const std::string& config, OIIO::ROI size, std::string& error);

    /// nullptr, with the reason in `error`, if it cannot be read or converted. Lives as long as this.
    const AlbedoReader* reader(std::string& error);

    /// Its texture in linear light, not resized: as make_lightmap() wants it. Errors have the place of the recipe's
    /// key `albedo`.
    bool make_whole(OIIO::ImageBuf& dst, const LightmapRecipe& recipe, const MakeOptions& options, std::string& error);

    bool read(OIIO::ROI roi, float* dst, std::string& error) override;
    bool make(std::vector<OIIO::ImageBuf>& dst, ImageRange range, const MakeOptions& options,
              std::string& error) override;
    bool failed() const override { return m_prepare.failed() || m_image->failed(); }
    size_t bytes() const override { return m_bytes; }

    AlbedoSource(const std::string& key, const LightmapRecipe& recipe, PixelSourcePointer image, OIIO::ROI size);

private:
    bool prepare(std::string& error);

    const std::string m_path;
    const ColorSettings m_color;
    const OIIO::ROI m_size;
    const PixelSourcePointer m_image;
    Once m_prepare;
    OIIO::ImageBuf m_pixels;
    AlbedoReader m_reader;
    std::atomic<size_t> m_bytes { 0 };
};

} // namespace vmlight
