// SPDX-License-Identifier: Apache-2.0
/// What the tests of image files write.
#pragma once

#include <vmlight/base/format.h>
#include <vmlight/image/channels.h>
#include <vmlight/image/color.h>
#include <vmlight/image/image_file.h>

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight::written_images {

/// In double quotes; not "\"" + path + "\"", of which GCC 12 warns falsely.
inline std::string quoted(const std::string& path)
{
    return format("\"{}\"", path);
}

inline OIIO::ImageBuf vismap_like(int width, int height, float factor = 1)
{
    OIIO::ImageSpec spec(width, height, 5, OIIO::TypeDesc::FLOAT);
    spec.channelnames = { "visibility", "direction.x", "direction.y", "direction.z", "coverage" };
    spec.tile_width = spec.tile_height = 64;
    tag_data(spec);
    spec.attribute("vmlight:stage", "vismap");
    OIIO::ImageBuf image(spec, OIIO::InitializePixels::Yes);
    for (OIIO::ImageBuf::Iterator<float> p(image); !p.done(); ++p)
        for (int c = 0; c < 5; ++c)
            p[c] = factor * (0.125f * float(c) - 0.001f * float(p.x()) + 0.5f * float(p.y()));
    return image;
}

inline bool write(const OIIO::ImageBuf& image, const std::string& path, std::string& error, const FileParams& file = {})
{
    return write_image(image, path, file, {}, error);
}

} // namespace vmlight::written_images
