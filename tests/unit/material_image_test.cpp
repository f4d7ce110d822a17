// SPDX-License-Identifier: Apache-2.0
// Images in the text of a mesh file.
#include <vmlight/stage/material_image.h>
#include <vmlight/stage/material_texture.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>

using namespace vmlight;
using testing::HasSubstr;

namespace {

std::string big_endian(uint32_t x)
{
    return { char(x >> 24), char(x >> 16), char(x >> 8), char(x) };
}

std::string chunk(const std::string& name_and_data)
{
    uint32_t crc = ~0u;
    for (const char c : name_and_data) {
        crc ^= uint8_t(c);
        for (int bit = 0; bit < 8; ++bit)
            crc = (crc >> 1) ^ ((crc & 1) ? 0xedb88320u : 0);
    }
    return big_endian(uint32_t(name_and_data.size() - 4)) + name_and_data + big_endian(~crc);
}

// A file that says to be so large, with next to no pixels.
MaterialTexture png_of_size(uint32_t side)
{
    MaterialTexture texture;
    texture.path = "hero.glb";
    texture.embedded = std::make_shared<const std::string>(
        "\x89PNG\r\n\x1a\n" + chunk("IHDR" + big_endian(side) + big_endian(side) + std::string("\x08\x02\0\0\0", 5))
        + chunk("IDAT" + std::string(8, 'x')));
    return texture;
}

} // namespace

TEST(MaterialImage, WhatDoesNotFitInMemoryIsRefusedByItsHeader)
{
    // OpenImageIO 3 refuses it when it is opened.
    const auto is_too_large = testing::AnyOf(HasSubstr("memory"), HasSubstr("limits:imagesize_MB"));
    OIIO::ImageBuf image;
    std::string error;
    EXPECT_FALSE(MaterialImage::read_all(image, png_of_size(900000), 3, error));
    EXPECT_THAT(error, HasSubstr("\"hero.glb\": "));
    EXPECT_THAT(error, is_too_large);
    // As a texture of colours too.
    std::array<int, 3> index;
    error.clear();
    EXPECT_FALSE(read_material_texture(image, index, png_of_size(900000), {}, 1, error));
    EXPECT_THAT(error, is_too_large);
}

TEST(MaterialImage, BrokenPixelsAreAnError)
{
    OIIO::ImageBuf image;
    std::string error;
    EXPECT_FALSE(MaterialImage::read_all(image, png_of_size(8), 3, error));
    EXPECT_THAT(error, HasSubstr("\"hero.glb\": a texture in it: "));
}
