// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

/// A row of pixels, from the values of their channels.
inline OIIO::ImageBuf image_of(int channels, const std::vector<float>& values)
{
    OIIO::ImageBuf image(OIIO::ImageSpec(int(values.size()) / channels, 1, channels, OIIO::TypeFloat));
    std::copy(values.begin(), values.end(), static_cast<float*>(image.localpixels()));
    return image;
}

/// The image that a file of these bytes holds; its alpha has not been multiplied into its colours.
/// @param name     says which format, and differs from those of all images that still exist
inline OIIO::ImageBuf exported_image(const std::string& bytes, const char* name)
{
    OIIO::Filesystem::IOMemReader reader(bytes.data(), bytes.size());
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    OIIO::ImageBuf image(name, 0, 0, nullptr, &config, &reader);
    EXPECT_TRUE(image.read(0, 0, true, OIIO::TypeFloat)) << image.geterror();
    return image;
}
