// SPDX-License-Identifier: Apache-2.0
// The images that tests start from, and what they look at in those that commands write.
#include "command_test.h"

#include <vmlight/base/oiio_compat.h>

#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace vmlight {

float Pixels::least() const
{
    return values.empty() ? NAN : *std::min_element(values.begin(), values.end());
}

float Pixels::greatest() const
{
    return values.empty() ? NAN : *std::max_element(values.begin(), values.end());
}

// Not through OpenImageIO's cache, which would keep what a test has just replaced.
Pixels CommandTest::pixels(const std::string& name, int subimage) const
{
    Pixels read;
    const auto input = OIIO::ImageInput::open(name);
    if (!input || !input->seek_subimage(subimage, 0)) {
        ADD_FAILURE() << name << ": " << (input ? input->geterror() : OIIO::geterror());
        return read;
    }
    const OIIO::ImageSpec spec = input->spec();
    read = { spec.width, spec.height, spec.nchannels, {} };
    read.values.resize(size_t(spec.image_pixels()) * size_t(spec.nchannels));
    EXPECT_TRUE(input->read_image(subimage, 0, 0, spec.nchannels, OIIO::TypeFloat, read.values.data()))
        << name << ": " << input->geterror();
    return read;
}

Pixels CommandTest::visibility(const std::string& name) const
{
    Pixels all = pixels(name);
    const std::vector<std::string> channels = channel_names(name);
    const size_t at = size_t(std::find(channels.begin(), channels.end(), "visibility") - channels.begin());
    EXPECT_LT(at, channels.size()) << name;
    std::vector<float> values;
    for (size_t i = at; i < all.values.size(); i += channels.size())
        values.push_back(all.values[i]);
    return { all.width, all.height, 1, values };
}

void CommandTest::expect_same_pixels(const std::string& a, const std::string& b, float tolerance) const
{
    const Pixels one = pixels(a), other = pixels(b);
    ASSERT_EQ(std::tie(one.width, one.height, one.channels), std::tie(other.width, other.height, other.channels))
        << a << " " << b;
    float worst = 0;
    for (size_t i = 0; i < one.values.size(); ++i)
        if (const float off = std::abs(one.values[i] - other.values[i]); !(off <= worst))
            worst = off;
    EXPECT_LE(worst, tolerance) << a << " " << b;
}

void CommandTest::expect_finite(const std::string& name) const
{
    for (int subimage = 0; subimage == 0 || OIIO::ImageInput::open(name)->seek_subimage(subimage, 0); ++subimage)
        for (const float value : pixels(name, subimage).values)
            ASSERT_TRUE(std::isfinite(value)) << name;
    OIIO::geterror(); // of the image after the last
}

std::string CommandTest::attribute(const std::string& name, const std::string& attribute) const
{
    const auto input = OIIO::ImageInput::open(name);
    EXPECT_TRUE(input) << name;
    const OIIO::ParamValue* found = input ? input->spec().find_attribute(attribute) : nullptr;
    return found ? found->get_string() : "";
}

std::vector<std::string> CommandTest::channel_names(const std::string& name) const
{
    const auto input = OIIO::ImageInput::open(name);
    EXPECT_TRUE(input) << name;
    return input ? input->spec().channelnames : std::vector<std::string>();
}

void CommandTest::make_vismap() const
{
    write("quad.obj", kQuad);
    done("makevismap quad.obj -o vm.exr --resolution 32 --samples 8 --quiet");
}

void CommandTest::make_sky(const std::vector<float>& color, const std::string& name, int width, int height) const
{
    OIIO::ImageBuf sky(OIIO::ImageSpec(width, height, int(color.size()), OIIO::TypeFloat));
    OIIO::ImageBufAlgo::fill(sky, color);
    EXPECT_TRUE(sky.write(path(name))) << sky.geterror();
}

void CommandTest::shrink(const std::string& src, const std::string& dst) const
{
    const OIIO::ImageBuf whole(path(src));
    OIIO::ImageBuf small;
    oiio::resize(small, whole, OIIO::ROI(0, 32, 0, 32), 0, "box");
    EXPECT_TRUE(small.write(path(dst))) << small.geterror();
}

} // namespace vmlight
