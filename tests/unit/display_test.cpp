// SPDX-License-Identifier: Apache-2.0
// Pictures for screens: the display transform, and the files.
#include "color_case.h"
#include "image_count.h"
#include "temporary_folder.h"

#include <vmlight/image/display.h>
#include <vmlight/image/picture_file.h>

#include <OpenImageIO/color.h>
#include <OpenImageIO/imagebufalgo.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

using namespace color_case;
using testing::HasSubstr;

namespace {

class Display : public Color
{
protected:
    bool show(ImageBuf& image, const DisplayParams& params, const std::string& config)
    {
        note.clear();
        error.clear();
        return show_on_display(image, params, config.empty() ? "lin_rec709_scene" : "", config, 1, note, error);
    }
    static ImageBuf rgba(const std::vector<float>& pixel)
    {
        ImageSpec spec(2, 2, 4, OIIO::TypeFloat);
        ImageBuf image(spec);
        OIIO::ImageBufAlgo::fill(image, pixel);
        return image;
    }
};

} // namespace

TEST_F(Display, WithoutAConfigItIsTheCurveOfSrgb)
{
    ImageBuf image = rgba({ 0.18f, 1.7f, -0.3f, 1 });
    ASSERT_TRUE(show(image, {}, "")) << error;
    EXPECT_NEAR(image.getchannel(0, 0, 0, 0), 0.461356f, 1e-5);
    EXPECT_EQ(image.getchannel(0, 0, 0, 1), 1);
    EXPECT_EQ(image.getchannel(0, 0, 0, 2), 0);
    EXPECT_EQ(note, "display: sRGB (no OCIO config)");
    DisplayParams params;
    params.view = "Film";
    EXPECT_FALSE(show(image, params, ""));
    EXPECT_THAT(error, HasSubstr("--colorconfig or $OCIO"));
}

TEST_F(Display, ColourIsDividedByAlphaBefore)
{
    ImageBuf image = rgba({ 0.09f, 0, 0, 0.5f });
    ASSERT_TRUE(show(image, {}, "")) << error;
    EXPECT_NEAR(image.getchannel(0, 0, 0, 0), 0.461356f, 1e-5);
    EXPECT_EQ(image.getchannel(0, 0, 0, 3), 0.5f);
}

TEST_F(Display, NumbersAreClampedAndDividedByAlphaAlone)
{
    ImageBuf image = rgba({ 0.25f, -1, 4, 0.5f });
    show_numbers(image);
    float shown[4];
    image.getpixel(0, 0, shown);
    EXPECT_THAT(shown, testing::ElementsAre(0.5f, 0, 1, 0.5f));
}

TEST_F(Display, EveryViewOfTheConfigIsClamped)
{
    const OIIO::ColorConfig config(kConfig);
    for (const std::string& display : config.getDisplayNames())
        for (const std::string& view : config.getViewNames(display)) {
            ImageBuf image = rgba({ 0.02f, 5.0f, 0.01f, 1 });
            DisplayParams params;
            params.display = display;
            params.view = view;
            ASSERT_TRUE(show(image, params, kConfig)) << error;
            for (int c = 0; c < 3; ++c) {
                EXPECT_GE(image.getchannel(0, 0, 0, c), 0) << display << " " << view;
                EXPECT_LE(image.getchannel(0, 0, 0, c), 1) << display << " " << view;
            }
            EXPECT_THAT(note, HasSubstr(display));
        }
}

TEST_F(Display, NamesThatTheConfigLacksAreRefused)
{
    ImageBuf image = rgba({ 1, 1, 1, 1 });
    DisplayParams params;
    params.display = "Tube";
    EXPECT_FALSE(show(image, params, kConfig));
    EXPECT_THAT(error, HasSubstr("has no display \"Tube\"; it has "));
    params.display.clear();
    params.view = "Upside down";
    EXPECT_FALSE(show(image, params, kConfig));
    EXPECT_THAT(error, HasSubstr("has no view \"Upside down\"; it has "));
    EXPECT_FALSE(show(image, {}, "/no/such/config.ocio"));
    EXPECT_THAT(error, HasSubstr("/no/such/config.ocio"));
}

TEST_F(Display, PicturesAreWhatWasWritten)
{
    const TemporaryFolder folder;
    ImageBuf image = rgba({ 0.2f, 0.4f, 0.6f, 0.5f });
    for (const char* name : { "a.png", "a.tif", "a.PNG" }) {
        ASSERT_TRUE(write_picture(image, folder / name, error)) << error;
        OIIO::ImageSpec config;
        config.attribute("oiio:UnassociatedAlpha", 1);
        ImageBuf back(folder / name, 0, 0, nullptr, &config);
        ASSERT_TRUE(back.read(0, 0, true, OIIO::TypeFloat)) << name;
        EXPECT_NEAR(back.getchannel(0, 0, 0, 0), 0.2f, 1.0 / 255) << name;
        EXPECT_NEAR(back.getchannel(0, 0, 0, 2), 0.6f, 1.0 / 255) << name;
        EXPECT_NEAR(back.getchannel(0, 0, 0, 3), 0.5f, 1.0 / 255) << name;
    }
    ASSERT_TRUE(write_picture(image, folder / "a.jpg", error)) << error; // over black
    ImageBuf flat(folder / "a.jpg");
    ASSERT_TRUE(flat.read(0, 0, true, OIIO::TypeFloat));
    EXPECT_EQ(flat.nchannels(), 3);
    EXPECT_NEAR(flat.getchannel(0, 0, 0, 2), 0.3f, 0.02);
    std::vector<ImageBuf> frames(3, image);
    ASSERT_TRUE(write_animation(frames, folder / "a.gif", 12, error)) << error;
    EXPECT_EQ(image_count(folder / "a.gif"), 3);
}

// OIIO's TIFF writer is given one thread: see write().
TEST_F(Display, PicturesAreTheSameForAnyNumberOfThreads)
{
    const TemporaryFolder folder;
    ImageBuf image(ImageSpec(256, 256, 4, OIIO::TypeFloat));
    OIIO::ImageBufAlgo::noise(image, "uniform", 0, 1);
    image.specmod().alpha_channel = 3;
    int before = 0;
    OIIO::getattribute("threads", before);
    for (const char* extension : { "tif", "png" }) {
        std::vector<std::string> bytes;
        for (const int threads : { 1, 5 }) {
            OIIO::attribute("threads", threads);
            const std::string name = std::to_string(threads) + "." + extension;
            EXPECT_TRUE(write_picture(image, folder / name, error)) << error;
            bytes.push_back(folder.bytes(name));
        }
        EXPECT_TRUE(bytes[0] == bytes[1]) << extension;
        EXPECT_EQ(ImageBuf(folder / ("1." + std::string(extension))).spec().get_string_attribute("DateTime"), "");
    }
    OIIO::attribute("threads", before);
}

TEST_F(Display, WhatCannotBeWrittenLeavesNothing)
{
    const TemporaryFolder folder;
    EXPECT_FALSE(write_picture(rgba({ 1, 1, 1, 1 }), folder / "a.txt", error));
    EXPECT_THAT(error, HasSubstr("png, jpg, webp"));
    EXPECT_FALSE(write_picture(rgba({ 1, 1, 1, 1 }), folder / "none/a.png", error));
    EXPECT_THAT(error, HasSubstr("none"));
    EXPECT_TRUE(std::filesystem::is_empty(folder / ""));
    EXPECT_TRUE(is_picture_name("A.JPG"));
    EXPECT_FALSE(is_picture_name("a.exr"));
    EXPECT_TRUE(is_animation_name("a.gif"));
    EXPECT_FALSE(is_animation_name("a.png"));
}
