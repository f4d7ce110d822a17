// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

#include <string>

namespace vmlight {

/// How many images a file has; 0 if it cannot be opened. (From OpenImageIO 2.5 on, ImageBuf::nsubimages() is 0 where
/// counting means reading.)
inline int image_count(const std::string& path)
{
    const auto file = OIIO::ImageInput::open(path);
    int count = 0;
    while (file && file->seek_subimage(count, 0))
        ++count;
    return count;
}

} // namespace vmlight
