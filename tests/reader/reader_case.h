// SPDX-License-Identifier: Apache-2.0
/// Recipes read as images, by the plugins that OpenImageIO finds in its search path: this process as their host.
#pragma once

#include "command_test.h"

#include <OpenImageIO/imagebuf.h>

#include <filesystem>

namespace vmlight {

/// hero.vismap, studio.cfem and hero.lightmap, with what they read, in the current folder.
class ReaderTest : public CommandTest
{
protected:
    void SetUp() override
    {
        std::filesystem::copy_file(kSpot, "spot.obj");
        std::filesystem::copy_file(kSky, "studio.hdr");
        write("hero.vismap", "mesh = \"spot.obj\"\nresolution = [200, 150]\nsamples = 8\n");
        write("studio.cfem", "environment = \"studio.hdr\"\nresolution = 64\n");
        write("hero.lightmap", "vismap = \"hero.vismap\"\ncfem = \"studio.cfem\"\nrotate = [0, 30, 0]\n");
    }

    static OIIO::ImageSpec spec_of(const std::string& name)
    {
        const auto input = OIIO::ImageInput::open(name);
        EXPECT_TRUE(input) << name << ": " << OIIO::geterror();
        return input ? input->spec() : OIIO::ImageSpec();
    }
    /// As a host converts.
    void convert(const std::string& recipe, const std::string& image) const
    {
        OIIO::ImageBuf whole(recipe);
        EXPECT_TRUE(whole.write(image)) << whole.geterror();
    }
    /// The plugin's error: on opening, or on reading all pixels. "" if there is none.
    static std::string error_of(const std::string& name)
    {
        const auto input = OIIO::ImageInput::open(name);
        if (!input)
            return OIIO::geterror();
        const OIIO::ImageSpec& spec = input->spec();
        std::vector<float> pixels(size_t(spec.image_pixels()) * size_t(spec.nchannels));
        return input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, pixels.data()) ? "" : input->geterror();
    }
    void expect_error(const std::string& text, const std::string& name) const
    {
        EXPECT_THAT(error_of(name), testing::HasSubstr(text)) << name;
    }
};

} // namespace vmlight
