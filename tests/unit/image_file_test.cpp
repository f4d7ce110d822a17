// SPDX-License-Identifier: Apache-2.0
#include "temporary_folder.h"
#include "written_images.h"

#include <vmlight/base/oiio_compat.h>

#include <OpenImageIO/imagebufalgo.h>
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <limits>

#include <sys/resource.h>

using namespace vmlight;
using namespace vmlight::written_images;

namespace {

// While it exists, no file can grow beyond `bytes`.
class FileLimit
{
public:
    explicit FileLimit(size_t bytes)
        : m_handler(std::signal(SIGXFSZ, SIG_IGN))
    {
        EXPECT_EQ(::getrlimit(RLIMIT_FSIZE, &m_before), 0);
        const rlimit limit { bytes, m_before.rlim_max };
        EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
    }
    FileLimit(const FileLimit&) = delete;
    ~FileLimit()
    {
        EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &m_before), 0);
        std::signal(SIGXFSZ, m_handler);
    }

private:
    void (*const m_handler)(int);
    rlimit m_before;
};

} // namespace

TEST(ImageFile, WhatIsWrittenIsReadBackByName)
{
    const TemporaryFolder folder;
    const OIIO::ImageBuf image = vismap_like(70, 66);
    std::string error;
    ASSERT_TRUE(write(image, folder / "a.exr", error)) << error;
    OIIO::ImageBuf back;
    ASSERT_TRUE(read_image(back, folder / "a.exr", error)) << error;
    ASSERT_EQ(back.nchannels(), 5);
    for (int c = 0; c < 5; ++c) {
        const int k = back.spec().channelindex(image.spec().channelnames[size_t(c)]);
        ASSERT_GE(k, 0) << image.spec().channelnames[size_t(c)];
        for (int y = 0; y < 66; ++y)
            for (int x = 0; x < 70; ++x)
                ASSERT_EQ(back.getchannel(x, y, 0, k), image.getchannel(x, y, 0, c));
    }
    std::array<int, 4> index;
    EXPECT_TRUE(find_vismap_channels(back.spec(), index, error)) << error;
    EXPECT_EQ(back.spec().get_string_attribute("vmlight:stage"), "vismap");
    EXPECT_EQ(back.spec().get_string_attribute("colorInteropID"), "data");
    EXPECT_EQ(back.spec().get_string_attribute("compression"), "zip");
    EXPECT_EQ(back.nativespec().tile_width, 64);
    EXPECT_EQ(back.nativespec().format, OIIO::TypeDesc::FLOAT);
}

TEST(ImageFile, HalfIsWrittenOnRequest)
{
    const TemporaryFolder folder;
    std::string error;
    ASSERT_TRUE(write(vismap_like(9, 9), folder / "a.exr", error, { "half" })) << error;
    OIIO::ImageBuf back(folder / "a.exr");
    EXPECT_EQ(back.nativespec().format, OIIO::TypeDesc::HALF);
    EXPECT_EQ(back.getchannel(0, 0, 0, back.spec().channelindex("direction.y")), 0.25f);
}

TEST(ImageFile, ErrorsOfOpenImageIOAreOnOneLine)
{
    OIIO::ImageBuf image;
    image.errorfmt("cannot decode");
    image.errorfmt("tile 3 is cut short\ncannot decode");
    EXPECT_EQ(oiio::error_line(image), "cannot decode; tile 3 is cut short");
    EXPECT_EQ(oiio::error_line(image), "");
}

TEST(ImageFile, UncompressedPixelsAreTheSame)
{
    const TemporaryFolder folder;
    std::string error;
    for (const char* format : { "float", "half" }) {
        const OIIO::ImageBuf image = vismap_like(70, 66, 1.0f / 64);
        ASSERT_TRUE(write(image, folder / "zip.exr", error, { format })) << error;
        ASSERT_TRUE(write(image, folder / "none.exr", error, { format, "none" })) << error;
        OIIO::ImageBuf zip, none;
        ASSERT_TRUE(read_image(zip, folder / "zip.exr", error)) << error;
        ASSERT_TRUE(read_image(none, folder / "none.exr", error)) << error;
        EXPECT_EQ(none.spec().get_string_attribute("compression"), "none");
        EXPECT_EQ(OIIO::ImageBufAlgo::compare(zip, none, 0, 0).maxerror, 0) << format;
    }
}

TEST(ImageFile, EqualPixelsGiveEqualBytes)
{
    const TemporaryFolder folder;
    std::string error;
    ASSERT_TRUE(write(vismap_like(70, 66), folder / "a.exr", error)) << error;
    ::sleep(1); // a date would show
    ASSERT_TRUE(write(vismap_like(70, 66), folder / "b.exr", error)) << error;
    EXPECT_TRUE(folder.bytes("a.exr") == folder.bytes("b.exr"));
    EXPECT_GT(folder.bytes("a.exr").size(), 1000u);
    for (const char* word : { "DateTime", "HostComputer", "Software", "Exif:ImageHistory" })
        EXPECT_EQ(folder.bytes("a.exr").find(word), std::string::npos) << word;
}

TEST(ImageFile, AnOutputReplacesTheOldOneAndLeavesNothingElse)
{
    const TemporaryFolder folder;
    std::string error;
    ASSERT_TRUE(write(vismap_like(4, 4), folder / "a.exr", error)) << error;
    ASSERT_TRUE(write(vismap_like(8, 8), folder / "a.exr", error)) << error;
    EXPECT_EQ(OIIO::ImageBuf(folder / "a.exr").spec().width, 8);
    EXPECT_EQ(folder.names(), std::vector<std::string> { "a.exr" });
}

TEST(ImageFile, SeveralImagesStandInOneFileOrNone)
{
    const TemporaryFolder folder;
    std::vector<OIIO::ImageBuf> images(3, vismap_like(70, 66));
    for (int i = 0; i < 3; ++i) {
        images[size_t(i)].specmod().attribute("oiio:subimagename", "image" + std::to_string(i));
        images[size_t(i)].setpixel(5, 5, std::vector<float>(5, float(i)));
    }
    std::string error;
    ASSERT_TRUE(write_images(images, folder / "a.exr", {}, {}, error)) << error;
    const std::string old = folder.bytes("a.exr");
    for (int i = 0; i < 3; ++i) {
        OIIO::ImageBuf back;
        ASSERT_TRUE(read_image(back, folder / "a.exr", error, i)) << error;
        EXPECT_EQ(back.nsubimages(), 3);
        EXPECT_EQ(back.getchannel(5, 5, 0, 0), float(i));
    }
    OIIO::ImageBuf none;
    EXPECT_FALSE(read_image(none, folder / "a.exr", error, 3));
    int calls = 0;
    EXPECT_FALSE(write_images(
        images, folder / "a.exr", {}, [&](double) { return ++calls < 4; }, error));
    EXPECT_EQ(error, quoted(folder / "a.exr") + ": interrupted");
    images[2].setpixel(3, 4, std::vector<float> { 0, 0, 1e6f, 0, 0 });
    EXPECT_FALSE(write_images(images, folder / "a.exr", { "half" }, {}, error));
    EXPECT_TRUE(folder.bytes("a.exr") == old);
    EXPECT_EQ(folder.names(), std::vector<std::string> { "a.exr" });
    ASSERT_TRUE(write_images(images, folder / "b.exr", {}, {}, error)) << error;
    ASSERT_TRUE(write_images(images, folder / "c.exr", {}, {}, error)) << error;
    EXPECT_TRUE(folder.bytes("b.exr") == folder.bytes("c.exr"));
}

TEST(ImageFile, WhereverTheDiskIsFullTheOldFileStaysOrTheNewOneIsWhole)
{
    const TemporaryFolder folder;
    std::string error;
    for (const size_t count : { 1, 3 }) {
        std::vector<OIIO::ImageBuf> images(count, vismap_like(9, 7));
        for (size_t i = 0; i < count; ++i)
            images[i].specmod().attribute("oiio:subimagename", "image" + std::to_string(i));
        ASSERT_TRUE(write_images(images, folder / "new.exr", {}, {}, error)) << error;
        const std::string whole = folder.bytes("new.exr");
        folder.write("a.exr", "old");
        for (size_t limit = 0; limit < whole.size(); limit += count == 1 ? 1 : 7) {
            {
                const FileLimit full(limit);
                ASSERT_FALSE(write_images(images, folder / "a.exr", {}, {}, error)) << limit;
            }
            // OpenEXR writes several parts itself, and does not always say what failed.
            ASSERT_EQ(error.find(quoted(folder / "a.exr") + ": " + (count == 1 ? "File too large" : "")), 0u) << error;
            ASSERT_EQ(folder.bytes("a.exr"), "old") << limit;
        }
        const FileLimit enough(whole.size());
        EXPECT_TRUE(write_images(images, folder / "a.exr", {}, {}, error)) << error;
        EXPECT_TRUE(folder.bytes("a.exr") == whole);
        EXPECT_EQ(folder.names(), (std::vector<std::string> { "a.exr", "new.exr" })) << "debris";
    }
}

TEST(ImageFile, AFileThatWasReplacedIsReadAsItIsNow)
{
    const TemporaryFolder folder;
    std::string error;
    for (const int side : { 4, 300, 7 }) {
        ASSERT_TRUE(write(vismap_like(side, side), folder / "a.exr", error)) << error;
        OIIO::ImageBuf back;
        ASSERT_TRUE(read_image(back, folder / "a.exr", error)) << error;
        EXPECT_EQ(back.spec().width, side);
    }
}

TEST(ImageFile, AHeaderWithASideBeyondAllImagesIsRefused)
{
    OIIO::ImageSpec spec(1 << 20, 1, 1);
    EXPECT_EQ(header_fault(spec), "");
    spec.full_height = (1 << 20) + 1;
    EXPECT_EQ(header_fault(spec), "its header says 1048576x1048577 pixels; the maximum is 1048576 per side");
}

TEST(ImageFile, AnInterruptedOutputLeavesTheOldFileAsItWas)
{
    const TemporaryFolder folder;
    std::string error;
    ASSERT_TRUE(write(vismap_like(4, 4), folder / "a.exr", error)) << error;
    const std::string old = folder.bytes("a.exr");
    for (int stop_at : { 1, 2, 4 }) {
        int calls = 0;
        error.clear();
        EXPECT_FALSE(write_image(
            vismap_like(300, 500), folder / "a.exr", {}, [&](double) { return ++calls < stop_at; }, error));
        EXPECT_EQ(error, quoted(folder / "a.exr") + ": interrupted");
        EXPECT_TRUE(folder.bytes("a.exr") == old);
        EXPECT_EQ(folder.names(), std::vector<std::string> { "a.exr" });
    }
}

TEST(ImageFile, ValuesBeyondHalfAreRefusedNotWrittenAsInfinity)
{
    const TemporaryFolder folder;
    std::string error;
    OIIO::ImageBuf image = vismap_like(8, 8);
    ASSERT_TRUE(write(image, folder / "a.exr", error, { "half" })) << error;
    const std::string old = folder.bytes("a.exr");
    for (float value : { 65505.0f, -1e6f }) {
        image.setpixel(3, 4, std::vector<float> { 0, 0, value, 0, 0 });
        EXPECT_FALSE(write(image, folder / "a.exr", error, { "half" }));
        const std::string reached = value > 0 ? "65505" : "1e+06";
        EXPECT_EQ(error,
                  format("\"{}\": channel direction.y reaches {}, but the maximum of half is 65504: "
                         "write float",
                         folder / "a.exr", reached));
        EXPECT_TRUE(folder.bytes("a.exr") == old);
    }
    image.setpixel(3, 4, std::vector<float> { 0, 0, 0, std::numeric_limits<float>::infinity(), 0 });
    EXPECT_FALSE(write(image, folder / "a.exr", error, { "half" }));
    EXPECT_EQ(error,
              format("\"{}\": channel direction.z reaches inf, but the maximum of half is 65504: "
                     "write float",
                     folder / "a.exr"));
    image.setpixel(3, 4, std::vector<float> { 65504, 0, 0, -65504, 0 });
    EXPECT_TRUE(write(image, folder / "a.exr", error, { "half" })) << error;
}

TEST(ImageFile, WhatCannotBeReadIsRefusedWithItsPath)
{
    const TemporaryFolder folder;
    OIIO::ImageBuf image(OIIO::ImageSpec(3, 3, 1, OIIO::TypeDesc::FLOAT));
    std::string error;
    EXPECT_FALSE(read_image(image, folder / "none.exr", error));
    EXPECT_EQ(error, quoted(folder / "none.exr") + ": no such file");
    EXPECT_FALSE(read_image(image, folder / "", error));
    EXPECT_EQ(error, quoted(folder / "") + ": not a file");
    folder.write("noise.exr", std::string("\x01\x02\x03 no image"));
    EXPECT_FALSE(read_image(image, folder / "noise.exr", error));
    EXPECT_EQ(error.find(quoted(folder / "noise.exr") + ": "), 0u) << error;
    EXPECT_GT(error.size(), (folder / "noise.exr").size() + 6);
    EXPECT_EQ(error.find('\n'), std::string::npos);
    EXPECT_FALSE(image.initialized());
    EXPECT_EQ(error.rfind("noise.exr"), error.find("noise.exr")) << "named twice: " << error;
    ASSERT_TRUE(write(vismap_like(300, 300), folder / "cut.exr", error)) << error;
    folder.write("cut.exr", folder.bytes("cut.exr").substr(0, 3000));
    EXPECT_FALSE(read_image(image, folder / "cut.exr", error));
    EXPECT_EQ(error.find(quoted(folder / "cut.exr") + ": "), 0u) << error;
    EXPECT_EQ(error.rfind("cut.exr"), error.find("cut.exr")) << "named twice: " << error;
}
