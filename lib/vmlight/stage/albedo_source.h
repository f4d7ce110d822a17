// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/base/once_cache.h>
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

/// The albedo for lightmaps of one size, in linear light. Converted and resized as a whole on first use, then shared by
/// all rotations and exposures.
class AlbedoSource : public PixelSource
{
public:
    /// @param image    the texture
    /// @param config   stamp_config() of the recipe's colorconfig
    /// @param working  interop id of the light, for use where there is no config
    /// @param size     the pixel window of the visibility map
    /// @returns nullptr, with the reason in `error`, if the texture has no colour
    static std::shared_ptr<AlbedoSource> open(const LightmapRecipe& recipe, PixelSourcePointer image,
                                              const std::string& config, const std::string& working, OIIO::ROI size,
                                              std::string& error);

    /// nullptr, with the reason in `error`, if it cannot be read or converted. Valid as long as this source.
    const AlbedoReader* reader(std::string& error);

    /// How its colours are converted, such as "sRGB -> ACEScg"; "" if they are not, or if that fails, which reader()
    /// reports.
    std::string conversion_note() const;

    bool read(OIIO::ROI roi, float* dst, std::string& error) override;
    /// The texture in linear light, but not resized: make_lightmap() does that.
    bool make(std::vector<OIIO::ImageBuf>& dst, ImageRange range, const MakeOptions& options,
              std::string& error) override;
    bool failed() const override { return m_prepare.failed() || m_image->failed(); }
    size_t bytes() const override { return m_bytes; }

    AlbedoSource(const std::string& key, const LightmapRecipe& recipe, PixelSourcePointer image,
                 const std::string& working, OIIO::ROI size);

private:
    bool prepare(std::string& error);

    const std::string m_path;
    const ColorSettings m_color;
    const OIIO::ROI m_size;
    const PixelSourcePointer m_image;
    RunOnce m_prepare;
    OIIO::ImageBuf m_pixels;
    AlbedoReader m_reader;
    std::atomic<size_t> m_bytes { 0 };
};

} // namespace vmlight
