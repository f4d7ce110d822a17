// SPDX-License-Identifier: Apache-2.0
/// Small images brought to scene-linear light, and what was said: for the tests of the colour rooms.
#pragma once

#include <vmlight/image/color.h>

#include <OpenImageIO/imagebufalgo.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

namespace color_case {

using namespace vmlight;
using OIIO::ImageBuf;
using OIIO::ImageSpec;

inline const std::string kConfig = VMLIGHT_TEST_OCIO;

/// The caller's $OCIO is put back after each test.
class Color : public testing::Test
{
protected:
    Color()
        : m_had(std::getenv("OCIO") != nullptr)
        , m_old(m_had ? std::getenv("OCIO") : "")
    {
        unsetenv("OCIO");
    }
    ~Color() override
    {
        if (m_had)
            setenv("OCIO", m_old.c_str(), 1);
        else
            unsetenv("OCIO");
    }

    /// Converts, and keeps what was said.
    bool convert(ImageBuf& image, const std::string& path, const ColorSettings& settings)
    {
        note.clear();
        error.clear();
        return to_scene_linear(image, path, settings, note, error);
    }
    /// The note, or the error, for a small image of `path`.
    std::string said(const std::string& path, const ColorSettings& settings, OIIO::TypeDesc format = OIIO::TypeFloat)
    {
        ImageBuf image = flat({ 0.8f, 0.2f, 0.1f }, format);
        return convert(image, path, settings) ? note : "ERROR " + error;
    }

    static ImageBuf flat(const std::vector<float>& pixel, OIIO::TypeDesc format = OIIO::TypeFloat, int size = 3)
    {
        ImageBuf image(ImageSpec(size, size, int(pixel.size()), format));
        OIIO::ImageBufAlgo::fill(image, pixel);
        return image;
    }
    static void expect_pixel(const ImageBuf& image, const std::vector<float>& expected, float tolerance)
    {
        std::vector<float> pixel(image.nchannels());
        image.getpixel(1, 1, pixel.data(), image.nchannels());
        ASSERT_EQ(pixel.size(), expected.size());
        for (size_t c = 0; c < expected.size(); ++c)
            EXPECT_NEAR(pixel[c], expected[c], tolerance) << "channel " << c;
    }
    static std::string id_of(const ImageBuf& image) { return image.spec().get_string_attribute("colorInteropID"); }

    std::string note, error;

private:
    bool m_had;
    std::string m_old;
};

} // namespace color_case
