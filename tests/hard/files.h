// SPDX-License-Identifier: Apache-2.0
/// What the tests of hard files share: inputs of each kind, and what a run may end in.
#pragma once

#include "command_test.h"
#include "damage.h"

#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/strutil.h>

#include <cmath>

namespace vmlight {

/// quad.obj, sky.exr, sky.hdr, vm.exr and cfem.exr, in the current folder.
class Files : public CommandTest
{
protected:
    const std::string small = " --resolution 16 --samples 4 --quiet";

    void SetUp() override
    {
        write("quad.obj", kQuad);
        OIIO::ImageBuf sky(OIIO::ImageSpec(16, 8, 3, OIIO::TypeFloat));
        OIIO::ImageBufAlgo::checker(sky, 8, 8, 1, { 0.1f, 0.2f, 0.3f }, { 2.0f, 3.0f, 1.0f });
        for (const char* name : { "sky.exr", "sky.hdr" })
            ASSERT_TRUE(sky.write(path(name))) << sky.geterror();
        done("makevismap quad.obj -o vm.exr" + small);
        done("makecfem sky.exr -o cfem.exr --resolution 8 --quiet");
    }

    /// The run ended with `code` and one line, which holds `text`. Warnings come from the work before; libpng prints
    /// its own.
    static void expect_one_error(const Result& run, int code, const std::string& text = "")
    {
        EXPECT_EQ(run.code, code) << run.all();
        std::vector<std::string> lines;
        for (const std::string& line : OIIO::Strutil::splits(run.err, "\n"))
            if (!line.empty() && !OIIO::Strutil::starts_with(line, "libpng ")
                && line.find(" WARNING: ") == std::string::npos)
                lines.push_back(line);
        ASSERT_EQ(lines.size(), 1u) << run.err;
        EXPECT_THAT(lines[0], testing::MatchesRegex("make[a-z]+ ERROR: .*"));
        EXPECT_THAT(lines[0], testing::HasSubstr(text));
    }

    /// Each of a few damages of a file ends in x.exr of finite pixels, or in one line and no x.exr.
    ///
    /// @param line    makes x.exr of the file
    /// @param recipe  "", or what plugins read of it then
    void expect_survival(const std::string& name, const std::string& whole, const std::string& line,
                         const std::string& recipe) const;

    /// Reads a recipe by OpenImageIO's plugin of its stage. Returns the plugin's error, or "" and finite pixels.
    static std::string read_by_plugin(const std::string& name)
    {
        const auto input = OIIO::ImageInput::open(name);
        if (!input)
            return OIIO::geterror();
        const OIIO::ImageSpec& spec = input->spec();
        std::vector<float> pixels(size_t(spec.image_pixels()) * size_t(spec.nchannels));
        if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, pixels.data()))
            return input->geterror();
        for (const float value : pixels)
            EXPECT_TRUE(std::isfinite(value)) << name;
        return "";
    }
};

} // namespace vmlight
