// SPDX-License-Identifier: Apache-2.0
// What a recipe tells a host of itself, and how it fails there.
#include "reader_case.h"

#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <map>

using namespace vmlight;
using testing::HasSubstr;
using testing::Not;

namespace {

using ReaderInfo = ReaderTest;
using ReaderFaults = ReaderTest;

std::map<std::string, std::string> metadata(const OIIO::ImageSpec& spec)
{
    std::map<std::string, std::string> found;
    for (const OIIO::ParamValue& value : spec.extra_attribs) {
        const std::string name = value.name().string();
        const bool is_ours
            = OIIO::Strutil::starts_with(name, "vmlight:") || name == "chromaticities" || name == "colorInteropID";
        // But for what takes the mesh's vertices to know; and a file keeps no empty texts.
        if (is_ours && name != "vmlight:meshHash" && name != "vmlight:meshShape" && !value.get_string().empty())
            found[name] = value.get_string();
    }
    return found;
}

} // namespace

TEST_F(ReaderInfo, DescribingComputesNothing)
{
    // What takes the mesh or the environment's pixels to know cannot be known here.
    write("broken.obj", "this is no mesh\n");
    OIIO::ImageSpec plain(64, 32, 3, OIIO::TypeFloat);
    plain.attribute("compression", "none");
    OIIO::ImageBuf sky(plain);
    OIIO::ImageBufAlgo::fill(sky, { 1.0f, 1.0f, 1.0f });
    ASSERT_TRUE(sky.write(path("whole.exr"))) << sky.geterror();
    const std::string whole = read("whole.exr");
    write("cut.exr", whole.substr(0, whole.size() - 3000));
    write("x.vismap", "mesh = \"broken.obj\"\nresolution = 8192\nsamples = 100000\n");
    write("x.cfem", "environment = \"cut.exr\"\n");
    write("x.lightmap", "vismap = \"x.vismap\"\ncfem = \"x.cfem\"\nexposure = 1.5\n");

    const struct
    {
        const char* stage;
        int width, height, channels;
        std::string interop_id;
        std::map<std::string, std::string> others;
    } cases[] = {
        { "vismap", 8192, 8192, 4, "data", { { "vmlight:mesh", "broken.obj" }, { "vmlight:samples", "100000" } } },
        { "cfem", 128, 64, 3, "lin_rec709_scene", {} },
        { "lightmap", 8192, 8192, 3, "lin_rec709_scene", { { "vmlight:exposure", "1.5" } } },
    };
    for (const auto& [stage, width, height, channels, interop_id, others] : cases) {
        const auto input = OIIO::ImageInput::open(std::string("x.") + stage);
        ASSERT_TRUE(input) << OIIO::geterror();
        const OIIO::ImageSpec& spec = input->spec();
        EXPECT_STREQ(input->format_name(), stage);
        EXPECT_EQ(std::tuple(spec.width, spec.height, spec.nchannels), std::tuple(width, height, channels)) << stage;
        EXPECT_EQ(spec.format, OIIO::TypeFloat);
        EXPECT_EQ(std::pair(spec.tile_width, spec.tile_height), std::pair(64, 64)) << stage;
        std::map<std::string, std::string> found = metadata(spec);
        EXPECT_EQ(found["colorInteropID"], interop_id);
        EXPECT_EQ(found["vmlight:stage"], stage);
        for (const auto& [name, value] : others)
            EXPECT_EQ(found[name], value);
        for (const OIIO::ParamValue& value : spec.extra_attribs)
            EXPECT_THAT(value.get_string(), Not(HasSubstr(path("")))) << "a path in the metadata";
    }
    EXPECT_EQ(channel_names("x.vismap"),
              (std::vector<std::string> { "visibility", "direction.x", "direction.y", "direction.z" }));
    expect_error("broken.obj", "x.vismap?resolution=64");
    expect_error("cut.exr", "x.cfem");
}

TEST_F(ReaderInfo, ARecipeAndTheExecutableStoreTheSame)
{
    done("makevismap hero.vismap -o vm.exr");
    done("makecfem studio.cfem -o cfem.exr");
    done("makelightmap hero.lightmap -o lit.exr");
    write("env.lightmap",
          "vismap = \"hero.vismap\"\nenvironment = \"./studio.hdr\"\ncfem_filter = \"sh\"\n"
          "cfem_order = 4\n");
    done("makelightmap env.lightmap -o env.exr");
    std::map<std::string, std::string> stored;
    for (const auto& [recipe, image] : { std::pair("hero.vismap", "vm.exr"),
                                         { "studio.cfem", "cfem.exr" },
                                         { "hero.lightmap", "lit.exr" },
                                         { "env.lightmap", "env.exr" } }) {
        stored = metadata(spec_of(image));
        EXPECT_GT(stored.size(), 6u) << image;
        EXPECT_EQ(metadata(spec_of(recipe)), stored) << recipe;
    }
    EXPECT_EQ(stored["vmlight:environment"], "studio.hdr");
    EXPECT_EQ(stored["vmlight:cfem_filter"], "sh");
    EXPECT_EQ(stored["vmlight:cfem_order"], "4");
    EXPECT_EQ(stored["vmlight:cfem_resolution"], "128x64");
    EXPECT_EQ(stored["vmlight:cfem_sanitize"], "false");
    // The same, however the environment came to be filtered.
    done("makelightmap vm.exr cfem.exr --rotate 0,30,0 -o apart.exr");
    done("makelightmap vm.exr studio.hdr --cfem-resolution 64 --rotate 0,30,0 --model paper -o whole.exr");
    done("makecfem studio.cfem --stack -o stack.exr");
    done("makelightmap vm.exr stack.exr --rotate 0,30,0 --model paper -o level.exr");
    for (const char* name : { "apart.exr", "whole.exr", "level.exr" })
        EXPECT_TRUE(read(name) == read("lit.exr")) << name;
}

TEST_F(ReaderFaults, ForeignFilesAreLeftToTheirReaders)
{
    write("broken.png", "\x89PNG\r\n\x1a\n and no more");
    write("empty.png");
    for (const char* name : { "broken.png", "empty.png" })
        expect_error("PNG", name);
}

TEST_F(ReaderFaults, ABrokenRecipeIsNamed)
{
    write("empty.lightmap");
    std::string noise;
    for (unsigned i = 0, state = 1; i < 4000; ++i, state = state * 1664525 + 1013904223)
        noise += char(state >> 24);
    write("noise.lightmap", noise);
    write("word.lightmap", "rotation = [0, 90, 0]\n");
    std::filesystem::create_directory("folder.lightmap");
    for (const char* name : { "empty.lightmap", "noise.lightmap", "folder.lightmap", "hero.lightmap?rotate=abc" })
        expect_error(name, name);
    expect_error("unknown parameter \"rotation\"", "word.lightmap");
}

TEST_F(ReaderFaults, ARecipeThatReadsItselfIsNamed)
{
    const std::string rest = "vismap = \"hero.vismap\"\ncfem = \"studio.cfem\"\n";
    write("a.lightmap", rest + "albedo = \"b.lightmap\"\n");
    write("b.lightmap", rest + "albedo = \"a.lightmap\"\n");
    expect_error("a.lightmap\" reads itself", "a.lightmap");
    write("self.cfem", "environment = \"./self.cfem\"\n");
    expect_error("self.cfem\" reads itself", "self.cfem");
}

TEST_F(ReaderFaults, AMissingInputIsNamed)
{
    remove("spot.obj");
    expect_error("hero.lightmap\" line 1: vismap: \"hero.vismap\" line 1: mesh: \"spot.obj\": no such file",
                 "hero.lightmap");
}

// oiiotool checks whether a name is a file when it cannot be opened, and says only that.
TEST_F(ReaderFaults, ABadQueryIsPrintedOnce)
{
    testing::internal::CaptureStderr();
    for (int i = 0; i < 2; ++i)
        EXPECT_FALSE(OIIO::ImageInput::open("hero.lightmap?rotate=xyz"));
    OIIO::geterror();
    const std::string printed = testing::internal::GetCapturedStderr();
    EXPECT_THAT(printed, HasSubstr("rotate: \"xyz\""));
    EXPECT_EQ(std::count(printed.begin(), printed.end(), '\n'), 1) << printed;
}

TEST_F(ReaderFaults, AHintNamesTheRecipesOwnKey)
{
    make_sky({ 1, -1, 1 }, "negative.exr");
    write("direct.lightmap", "vismap = \"hero.vismap\"\nenvironment = \"negative.exr\"\n");
    write("bad.cfem", "environment = \"negative.exr\"\n");
    expect_error("; set cfem_sanitize to repair them", "direct.lightmap");
    expect_error("; set sanitize to repair them", "bad.cfem");
}
