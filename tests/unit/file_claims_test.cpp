// SPDX-License-Identifier: Apache-2.0
/// Headers that claim more than their file holds, and all valid files, which pass.
#include "temporary_folder.h"

#include <vmlight/image/file_claims.h>
#include <vmlight/image/image_file.h>

#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imagebufalgo.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

using namespace vmlight;
using testing::HasSubstr;

namespace {

const char* const kCompressions[] = { "none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab" };

OIIO::ImageSpec spec_of(int width, int height, OIIO::TypeDesc format = OIIO::TypeFloat)
{
    OIIO::ImageSpec spec(width, height, 3, format);
    spec.attribute("oiio:ColorSpace", "");
    return spec;
}

// The least that a file of such pixels can be: constant.
void write_constant(const std::string& path, const OIIO::ImageSpec& spec)
{
    OIIO::ImageBuf image(spec, OIIO::InitializePixels::Yes);
    const auto out = OIIO::ImageOutput::create("openexr");
    ASSERT_TRUE(out->open(path, spec)) << out->geterror();
    ASSERT_TRUE(out->write_image(spec.format, image.localpixels())) << out->geterror();
    ASSERT_TRUE(out->close());
}

std::string number_bytes(uint32_t value)
{
    std::string bytes;
    for (int shift = 0; shift < 32; shift += 8)
        bytes += char(value >> shift);
    return bytes;
}

std::string attribute(const std::string& name, const std::string& type, const std::string& value)
{
    return name + '\0' + type + '\0' + number_bytes(uint32_t(value.size())) + value;
}

std::string box_bytes(uint32_t width, uint32_t height)
{
    return number_bytes(0) + number_bytes(0) + number_bytes(width - 1) + number_bytes(height - 1);
}

// One half channel, nothing compressed, 4x3: 3 offsets, and 3 rows of 8 bytes behind 8 others.
struct Header
{
    uint32_t version = 2;
    std::string channels
        = std::string("Y\0", 2) + number_bytes(1) + number_bytes(0) + number_bytes(1) + number_bytes(1) + '\0';
    std::string compression = std::string(1, '\0'), window = box_bytes(4, 3), more;
    size_t rest = 3 * 8 + 3 * (8 + 8);

    std::string bytes() const
    {
        return "\x76\x2f\x31\x01" + number_bytes(version) + attribute("channels", "chlist", channels)
            + attribute("compression", "compression", compression) + attribute("dataWindow", "box2i", window) + more
            + '\0' + std::string(rest, 'x');
    }
};

std::string fault_of_bytes(const std::string& bytes)
{
    const TemporaryFolder folder;
    return claims_fault(folder.write("a.exr", bytes));
}

} // namespace

TEST(FileClaims, EveryCompressionOfAnEvenPictureIsWhatItSays)
{
    const TemporaryFolder folder;
    for (const char* compression : kCompressions)
        for (const OIIO::TypeDesc& format : { OIIO::TypeHalf, OIIO::TypeFloat, OIIO::TypeUInt })
            for (const int width : { 1, 7, 2048 })
                for (const int tile : { 0, 64 }) {
                    OIIO::ImageSpec spec = spec_of(width, width == 2048 ? 128 : 5, format);
                    spec.attribute("compression", compression);
                    spec.tile_width = spec.tile_height = tile;
                    write_constant(folder / "a.exr", spec);
                    EXPECT_EQ(claims_fault(folder / "a.exr"), "") << compression << " " << format << " " << width;
                }
}

TEST(FileClaims, LevelsPartsAndDeepPixelsAreWhatTheySay)
{
    const TemporaryFolder folder;
    for (const char* const rounding : { "up", "down" })
        for (const int height : { 1, 37, 100 }) {
            OIIO::ImageSpec config = spec_of(100, height);
            config.attribute("openexr:roundingmode", std::string(rounding) == "up" ? 1 : 0);
            const OIIO::ImageBuf image(spec_of(100, height), OIIO::InitializePixels::Yes);
            ASSERT_TRUE(
                OIIO::ImageBufAlgo::make_texture(OIIO::ImageBufAlgo::MakeTxTexture, image, folder / "mip.exr", config))
                << OIIO::geterror();
            EXPECT_EQ(claims_fault(folder / "mip.exr"), "") << rounding << " " << height;
        }

    std::vector<OIIO::ImageSpec> specs;
    for (int i = 0; i < 40; ++i) {
        specs.push_back(spec_of(10 + i, 20, OIIO::TypeHalf));
        specs.back().full_width = 50; // of all parts
        specs.back().attribute("oiio:subimagename",
                               "a name of a part, longer than thirty-one letters " + std::to_string(i));
    }
    const auto out = OIIO::ImageOutput::create("openexr");
    ASSERT_TRUE(out->open(folder / "parts.exr", int(specs.size()), specs.data())) << out->geterror();
    for (size_t i = 0; i < specs.size(); ++i) {
        ASSERT_TRUE(i == 0 || out->open(folder / "parts.exr", specs[i], OIIO::ImageOutput::AppendSubimage));
        const OIIO::ImageBuf image(specs[i], OIIO::InitializePixels::Yes);
        ASSERT_TRUE(out->write_image(OIIO::TypeHalf, image.localpixels())) << out->geterror();
    }
    ASSERT_TRUE(out->close());
    EXPECT_EQ(claims_fault(folder / "parts.exr"), "");

    for (const int tile : { 0, 16 }) {
        OIIO::ImageSpec spec(20, 10, 2, OIIO::TypeFloat);
        spec.channelnames = { "R", "Z" };
        spec.deep = true;
        spec.tile_width = spec.tile_height = tile;
        OIIO::DeepData empty;
        empty.init(spec);
        ASSERT_TRUE(out->open(folder / "deep.exr", spec)) << out->geterror();
        ASSERT_TRUE(out->write_deep_image(empty)) << out->geterror();
        ASSERT_TRUE(out->close());
        EXPECT_EQ(claims_fault(folder / "deep.exr"), "") << tile;
    }
}

TEST(FileClaims, AFileMayBeExactlyAsLongAsItsHeaderSays)
{
    Header header;
    header.window = box_bytes(4096, 2049); // of half floats
    header.rest = 2049 * (8 + 8 + 8192);
    EXPECT_EQ(fault_of_bytes(header.bytes()), "");
    --header.rest;
    EXPECT_EQ(fault_of_bytes(header.bytes()),
              "its header says 4096x2049 pixels, which take 16818192 bytes or more; the file has 16818191");
    header.compression = std::string(1, 1); // runs of 128 bytes in 2
    header.rest = 2049 * (8 + 8 + 128);
    EXPECT_EQ(fault_of_bytes(header.bytes()), "");
    --header.rest;
    EXPECT_THAT(fault_of_bytes(header.bytes()), HasSubstr("which take 295056 bytes or more; the file has 295055"));
    header.compression = std::string(1, 100); // of a future version
    header.rest = 0;
    EXPECT_EQ(fault_of_bytes(header.bytes()), "");
}

TEST(FileClaims, ASmallFileThatWasCutIsLeftToItsReaderButForItsTable)
{
    Header header;
    header.rest = 3 * 8;
    EXPECT_EQ(fault_of_bytes(header.bytes()), "");
    --header.rest;
    EXPECT_EQ(fault_of_bytes(header.bytes()),
              "its header says 4x3 pixels, which take 72 bytes or more; the file has 23");
}

TEST(FileClaims, AnySizeBeyondTheFileIsRefused)
{
    const std::string bytes = Header().bytes();
    for (const char* name : { "channels", "compression", "dataWindow" }) {
        const size_t at = bytes.find('\0', bytes.find('\0', bytes.find(name)) + 1) + 1;
        for (const uint32_t size : { uint32_t(bytes.size() - at - 4 + 1), 1u << 29, 0x7fffffffu, 0xffffffffu }) {
            std::string damaged = bytes;
            damaged.replace(at, 4, number_bytes(size));
            EXPECT_EQ(fault_of_bytes(damaged),
                      "its header says that \"" + std::string(name) + "\" has " + std::to_string(size)
                          + " bytes; the file has " + std::to_string(bytes.size() - at - 4) + " more");
        }
    }
    Header header;
    header.more = attribute("views", "stringvector", number_bytes(4) + "left" + number_bytes(1 << 30) + "right");
    EXPECT_THAT(fault_of_bytes(header.bytes()), HasSubstr("a string in \"views\" has 1073741824 bytes, of 5"));
    header.more = attribute("views", "stringvector", number_bytes(4) + "left" + number_bytes(5) + "right");
    EXPECT_EQ(fault_of_bytes(header.bytes()), "");
    header.more = attribute("preview", "preview", number_bytes(2) + number_bytes(1 << 30) + std::string(8, 'p'));
    EXPECT_THAT(fault_of_bytes(header.bytes()), HasSubstr("the preview has 2x1073741824 pixels, in 16 bytes"));
    header.more = attribute("preview", "preview", number_bytes(2) + number_bytes(1) + std::string(8, 'p'));
    EXPECT_EQ(fault_of_bytes(header.bytes()), "");
}

TEST(FileClaims, PixelsTilesAndLevelsBeyondTheFileAreRefused)
{
    Header wide;
    wide.window = box_bytes(1 << 20, 30);
    EXPECT_THAT(fault_of_bytes(wide.bytes()), HasSubstr("its header says 1048576x30 pixels, which take "));
    wide.compression = std::string(1, 3); // ZIP
    EXPECT_THAT(fault_of_bytes(wide.bytes()), HasSubstr("its header says 1048576x30 pixels"));
    Header high; // of which the table of offsets alone is too long
    high.window = box_bytes(1, 0x7fffffff);
    high.compression = std::string(1, 9);
    EXPECT_THAT(fault_of_bytes(high.bytes()), HasSubstr("its header says 1x2147483647 pixels"));

    Header tiled;
    tiled.version = 2 | 0x200;
    tiled.window = box_bytes(64, 64);
    tiled.compression = std::string(1, 3);
    tiled.rest = 16 * 8;
    const auto tiles = [&](uint32_t width, uint32_t height, int mode) {
        tiled.more = attribute("tiles", "tiledesc", number_bytes(width) + number_bytes(height) + char(mode));
        return fault_of_bytes(tiled.bytes());
    };
    EXPECT_EQ(tiles(16, 16, 0), "");
    EXPECT_THAT(tiles(1, 16, 0), HasSubstr("its header says 64x64 pixels, which take "));
    EXPECT_THAT(tiles(16, 16, 1), HasSubstr("its header says 64x64 pixels")); // 16 + 4 + 1 + ...
    EXPECT_THAT(tiles(16, 16, 2), HasSubstr("its header says 64x64 pixels"));
    EXPECT_EQ(tiles(8192, 16, 0), "");
    EXPECT_EQ(tiles(1 << 28, 16, 0), "its header says tiles of 268435456x16 in a picture of 64x64 pixels");
    EXPECT_EQ(tiles(0, 0, 0), "") << "which OpenEXR refuses";

    Header deep;
    deep.version = 2 | 0x800;
    deep.rest = 3 * 8;
    EXPECT_EQ(fault_of_bytes(deep.bytes()), "");
    --deep.rest;
    EXPECT_THAT(fault_of_bytes(deep.bytes()), HasSubstr("its header says 4x3 pixels"));
}

TEST(FileClaims, AHeaderThatEndsAnywhereIsNoCrash)
{
    Header header;
    header.more = attribute("views", "stringvector", number_bytes(4) + "left")
        + attribute("tiles", "tiledesc", number_bytes(16) + number_bytes(16) + '\1')
        + attribute("preview", "preview", number_bytes(1) + number_bytes(1) + "rgba");
    for (const uint32_t version : { 2u, 2u | 0x200, 2u | 0x1000 }) {
        header.version = version;
        const std::string bytes = header.bytes();
        for (size_t size = 0; size < bytes.size(); ++size)
            fault_of_bytes(bytes.substr(0, size));
    }
    EXPECT_EQ(fault_of_bytes(""), "");
    EXPECT_EQ(claims_fault("no such file"), "");
    EXPECT_EQ(claims_fault("/"), "");
}

TEST(FileClaims, RadianceScanlinesAreHeldAgainstTheFile)
{
    const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    const auto fault = [&](const std::string& size, size_t rest) {
        std::string scanlines(rest, 'x');
        if (rest >= 4) { // as those with runs begin; plain ones may begin with anything
            const int pixels = std::stoi(size.substr(size.rfind(' ') + 1));
            scanlines.replace(0, 4, { 2, 2, char(pixels >> 8), char(pixels) });
        }
        return fault_of_bytes(head + size + "\n" + scanlines);
    };
    EXPECT_EQ(fault("-Y 999999 +X 7", 999999 * 7 * 4), ""); // too short for runs
    EXPECT_EQ(fault("-Y 999999 +X 7", 999999 * 7 * 4 - 1),
              "its header says 999999 scanlines of 7 pixels, which take 27999972 bytes or more; the file has 27999971");
    EXPECT_EQ(fault("-Y 40000 +X 127", 40000 * 12), "");
    EXPECT_EQ(fault("-Y 40000 +X 127", 40000 * 12 - 1),
              "its header says 40000 scanlines of 127 pixels, which take 480000 bytes or more; the file has 479999");
    EXPECT_EQ(fault("-Y 40000 +X 128", 40000 * 20), "");
    EXPECT_THAT(fault("+X 40000 -Y 128", 40000 * 20 - 1), HasSubstr("40000 scanlines of 128 pixels"));
    EXPECT_THAT(fault("-Y 2 +X 128", 0), HasSubstr("cut off")) << "small: no claim, but no picture either";
    EXPECT_THAT(fault("-Y 1048576 +X 1048576", 1000), HasSubstr("which take 4398046511104 bytes or more"));
    EXPECT_EQ(fault("nothing", 0), "");
    const TemporaryFolder folder;
    for (const int width : { 7, 8, 127, 128, 129, 2048, 32767 }) { // at best, one run after the other
        OIIO::ImageBuf even(OIIO::ImageSpec(width, 3, 3, OIIO::TypeFloat), OIIO::InitializePixels::Yes);
        ASSERT_TRUE(even.write(folder / "even.hdr")) << even.geterror();
        EXPECT_EQ(claims_fault(folder / "even.hdr"), "") << width;
    }
}

TEST(FileClaims, WhoeverOpensAnImageRefusesThem)
{
    const TemporaryFolder folder;
    Header header;
    header.more = attribute("views", "stringvector", number_bytes(1 << 30));
    const std::string path = folder.write("a.exr", header.bytes());
    std::string error;
    EXPECT_EQ(open_image(path, error), nullptr);
    EXPECT_EQ(error, "\"" + path + "\": " + claims_fault(path));
    OIIO::ImageBuf image;
    error.clear();
    EXPECT_FALSE(read_image(image, path, error));
    EXPECT_EQ(error, "\"" + path + "\": " + claims_fault(path));
}
