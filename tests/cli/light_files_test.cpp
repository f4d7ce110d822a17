// SPDX-License-Identifier: Apache-2.0
// What is in an image file and what is light in it: layers, layouts, headers, and the spaces that light is written in.
#include "command_test.h"

#include <vmlight/base/format.h>

#include <OpenImageIO/color.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebufalgo.h>

using namespace vmlight;
using testing::HasSubstr;
using testing::Not;

namespace {

class LightFiles : public CommandTest
{
protected:
    /// A constant image; `channels` are its names.
    void make_image(const std::string& name, const std::vector<std::string>& channels, const std::vector<float>& values,
                    int width = 16, int height = 8) const
    {
        OIIO::ImageSpec spec(width, height, int(channels.size()), OIIO::TypeFloat);
        spec.channelnames = channels;
        OIIO::ImageBuf image(spec);
        OIIO::ImageBufAlgo::fill(image, values);
        ASSERT_TRUE(image.write(path(name))) << image.geterror();
    }
    void expect_colour(const std::string& name, const std::vector<float>& rgb, float tolerance = 1e-5f) const
    {
        const Pixels image = pixels(name);
        for (size_t i = 0; i < image.values.size(); ++i)
            ASSERT_NEAR(image.values[i], rgb[i % 3], tolerance) << name;
    }
    /// An EXR of several parts, each constant.
    void make_parts(const std::string& name, const std::vector<std::string>& parts,
                    const std::vector<std::vector<std::string>>& channels,
                    const std::vector<std::vector<float>>& values) const
    {
        std::vector<OIIO::ImageBuf> images;
        std::vector<OIIO::ImageSpec> specs;
        for (size_t i = 0; i < parts.size(); ++i) {
            OIIO::ImageSpec& spec = specs.emplace_back(16, 8, int(channels[i].size()), OIIO::TypeFloat);
            spec.channelnames = channels[i];
            spec.attribute("oiio:subimagename", parts[i]);
            OIIO::ImageBufAlgo::fill(images.emplace_back(spec), values[i]);
        }
        const auto out = OIIO::ImageOutput::create("openexr");
        ASSERT_TRUE(out && out->open(path(name), int(specs.size()), specs.data()));
        for (size_t i = 0; i < parts.size(); ++i) {
            ASSERT_TRUE(i == 0 || out->open(path(name), specs[i], OIIO::ImageOutput::AppendSubimage));
            ASSERT_TRUE(out->write_image(OIIO::TypeFloat, images[i].localpixels()));
        }
        ASSERT_TRUE(out->close());
    }
    static std::string header(const std::string& lines) { return "#?RADIANCE\n" + lines + "\n-Y 8 +X 16\n"; }
};

} // namespace

TEST_F(LightFiles, ALayerIsChosenByName)
{
    make_vismap();
    make_sky({ 1, 1, 1 });
    make_image("blender.exr",
               { "ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B", "ViewLayer.Combined.A",
                 "ViewLayer.Depth.Z", "ViewLayer.Mist.Y" },
               { 0.25f, 0.5f, 0.75f, 1, 9, 0.125f });
    refused(1, "choose a layer with --layer (--albedo-layer): ViewLayer.Combined, ViewLayer.Mist",
            "makecfem blender.exr -o x.exr");
    refused(1, "no layer \"ViewLayer.Combine\" with colour; did you mean \"ViewLayer.Combined\"?",
            "makecfem blender.exr --layer ViewLayer.Combine -o x.exr");
    refused(1, "a recipe has no layers", "makelightmap vm.exr sky.exr --albedo x.lightmap --albedo-layer a -o x.exr");
    done("makecfem blender.exr --layer ViewLayer.Combined -o a.exr");
    expect_colour("a.exr", { 0.25f, 0.5f, 0.75f });
    done("makelightmap vm.exr blender.exr --layer ViewLayer.Combined -o lit.exr");
    expect_colour("lit.exr", { 0.25f, 0.5f, 0.75f });
    done("makelightmap vm.exr sky.exr --albedo blender.exr --albedo-layer ViewLayer.Mist -o lit.exr");
    expect_colour("lit.exr", { 0.125f, 0.125f, 0.125f });
    write("x.lightmap",
          "vismap = \"vm.exr\"\nenvironment = \"sky.exr\"\nalbedo = \"blender.exr\"\nalbedo_layer = "
          "\"ViewLayer.Mist\"\n");
    done("makelightmap x.lightmap -o live.exr");
    expect_same_pixels("lit.exr", "live.exr", 0);
    // As a texture, which is read by the tile.
    write("quad.obj", kQuad);
    for (const std::string texture : { "lit.exr", "x.lightmap" })
        done("vmframes quad.obj --texture " + texture + " --size 16 -o of_" + texture + ".exr");
    expect_same_pixels("of_lit.exr.exr", "of_x.lightmap.exr", 0);
}

// Renderers name parts as they name layers, with and without the layer in the channels' names.
TEST_F(LightFiles, APartIsChosenByName)
{
    make_vismap();
    make_parts("parts.exr", { "depth", "beauty", "ViewLayer.Combined" },
               { { "Z" }, { "R", "G", "B", "A" }, { "Combined.R", "Combined.G", "Combined.B" } },
               { { 9 }, { 0.25f, 0.5f, 0.75f, 1 }, { 0.5f, 0.125f, 1 } });
    refused(1, "choose a layer with --layer: beauty, ViewLayer.Combined, Combined", "makecfem parts.exr -o x.exr");
    refused(1, "no layer \"depth\" with colour", "makecfem parts.exr --layer depth -o x.exr");
    done("makecfem parts.exr --layer beauty -o beauty.exr");
    expect_colour("beauty.exr", { 0.25f, 0.5f, 0.75f });
    for (const std::string layer : { "Combined", "ViewLayer.Combined" }) {
        done("makecfem parts.exr --layer " + layer + " -o combined.exr");
        expect_colour("combined.exr", { 0.5f, 0.125f, 1 });
        done("makelightmap vm.exr beauty.exr --albedo parts.exr --albedo-layer " + layer + " -o lit.exr");
        expect_colour("lit.exr", { 0.125f, 0.0625f, 0.75f });
    }
}

TEST_F(LightFiles, ChannelsThatAreNoLightAreRefused)
{
    for (const std::vector<std::string>& channels : std::vector<std::vector<std::string>> {
             { "depth.Z" }, { "mask.A" }, { "N.X" }, { "foo" }, { "U", "Y", "V" }, { "X", "Y", "Z" } }) {
        make_image("a.exr", channels, std::vector<float>(channels.size(), 1.0f));
        refused(1, "\"a.exr\": no channels R, G, B, and no Y of grey, among ", "makecfem a.exr -o x.exr");
    }
    refused(1, "set --colorspace lin_ciexyzd65_scene", "makecfem a.exr -o x.exr");
    make_image("grey.exr", { "Y" }, { 0.5f });
    done("makecfem grey.exr -o x.exr");
    expect_colour("x.exr", { 0.5f, 0.5f, 0.5f });
}

TEST_F(LightFiles, OtherLayoutsAreKnownByTheirShape)
{
    for (const auto& [width, height] :
         { std::pair(96, 16), { 16, 96 }, { 64, 48 }, { 48, 64 }, { 32, 32 }, { 1024, 768 } }) {
        make_sky({ 1, 2, 3 }, "sky.exr", width, height);
        refused(1, format("\"sky.exr\": {}x{} pixels is the shape of ", width, height), "makecfem sky.exr -o x.exr");
    }
    done("makecfem sky.exr --layout latlong -o x.exr");
    expect_colour("x.exr", { 1, 2, 3 });
    make_sky({ 1, 2, 3 }, "sky.exr", 64, 32);
    EXPECT_THAT(done("makecfem sky.exr -o x.exr"), Not(HasSubstr("shadows")));
}

TEST_F(LightFiles, AFileThatWasCopiedInPartIsCalledIncomplete)
{
    done("makevismap " + std::string(VMLIGHT_TEST_DATA) + "/spot.obj -o vm.exr --resolution 16 --samples 1 --quiet");
    make_image("sky.exr", { "R", "G", "B" }, { 1, 1, 1 });
    OIIO::ImageBuf noise(OIIO::ImageSpec(64, 64, 3, OIIO::TypeUInt8)); // which no compression shortens
    ASSERT_TRUE(OIIO::ImageBufAlgo::noise(noise, "white", 0, 1));
    for (const std::string extension : { "png", "hdr", "exr", "tif" }) {
        const std::string name = "part." + extension;
        ASSERT_TRUE(noise.write(path(name))) << noise.geterror();
        write(name, read(name).substr(0, read(name).size() / 2));
        const Result result = run("makelightmap vm.exr sky.exr --albedo " + name + " -o x.exr");
        EXPECT_EQ(result.code, 1);
        EXPECT_THAT(result.err,
                    HasSubstr("makelightmap ERROR: \"" + name // libpng prints a line of its own
                              + "\": cannot read its pixels; the file may be damaged or incomplete ("));
    }
    // OpenImageIO gives what is left of it, and black.
    refused(1, "\"part.tif\": cannot read its pixels; the file may be damaged or incomplete (",
            "makevismap " + std::string(VMLIGHT_TEST_DATA)
                + "/spot.obj --normal-map part.tif -o y.exr --resolution 16");
    refused(1, "\"part.tif\": cannot read its pixels; the file may be damaged or incomplete (",
            "vmframes " + std::string(VMLIGHT_TEST_DATA) + "/spot.obj --texture part.tif -o y.png --size 16");
}

TEST_F(LightFiles, AFilteredEnvironmentIsNotFilteredAgainWithoutAWord)
{
    make_image("sky.exr", { "R", "G", "B" }, { 1, 1, 1 });
    done("makecfem sky.exr -o once.exr");
    EXPECT_THAT(
        done("makecfem once.exr -o twice.exr"),
        HasSubstr("WARNING: \"once.exr\": filtered already (its vmlight:stage is \"cfem\") and filtered again"));
}

TEST_F(LightFiles, ASkyOfEightBitsIsWarnedOf)
{
    OIIO::ImageBuf sky(OIIO::ImageSpec(16, 8, 3, OIIO::TypeUInt8));
    OIIO::ImageBufAlgo::fill(sky, { 1, 1, 1 });
    for (const std::string name : { "sky.jpg", "sky.png" }) {
        ASSERT_TRUE(sky.write(path(name))) << sky.geterror();
        EXPECT_THAT(done("makecfem " + name + " -o x.exr"),
                    HasSubstr("\"" + name + "\": 8 bit, no light above 1: shadows will be weak"));
    }
}

TEST_F(LightFiles, RadianceHeadersAreReadAsTheyAre)
{
    std::string plain;
    for (int i = 0; i < 16 * 8; ++i)
        plain += "\x80\x40\x20\x81"; // 1, 1/2, 1/4
    const std::string rgbe = "FORMAT=32-bit_rle_rgbe\n";
    write("sky.hdr", header(rgbe + "EXPOSURE=2.0\nEXPOSURE=4\n") + plain);
    EXPECT_THAT(done("makecfem sky.hdr -o x.exr"),
                HasSubstr("light is used as stored: EXPOSURE=2.0, EXPOSURE=4 in the header is not divided out"));
    expect_colour("x.exr", { 1, 0.5f, 0.25f });
    write("sky.hdr", header(rgbe + "EXPOSURE=1\n") + plain);
    EXPECT_THAT(done("makecfem sky.hdr -o x.exr"), Not(HasSubstr("EXPOSURE")));

    write("xyze.hdr", header("FORMAT=32-bit_rle_xyze\n") + plain);
    refused(1, "\"xyze.hdr\": a Radiance picture of XYZE pixels cannot be read; convert it to RGBE with ra_xyze -r",
            "makecfem xyze.hdr -o x.exr");
    std::string runs;
    for (int y = 0; y < 8; ++y)
        runs += std::string("\x80\x40\x20\x81") + "\x01\x01\x01\x0f"; // a pixel, and 15 more of it
    write("old.hdr", header(rgbe) + runs);
    refused(1, "\"old.hdr\": a Radiance picture of old run-length encoding, or cut off", "makecfem old.hdr -o x.exr");
}

TEST_F(LightFiles, LightIsWrittenInTheSpaceThatIsAskedFor)
{
    make_vismap();
    make_sky({ 0.5f, 0.25f, 0.125f }, "sky_lin_rec709.exr");
    const std::string config = " --colorconfig {config} ";
    done("makecfem sky_lin_rec709.exr" + config + "-o acescg.exr");
    done("makecfem sky_lin_rec709.exr" + config + "--output-colorspace lin_rec709_scene -o rec709.exr");
    expect_colour("acescg.exr", { 0.397352f, 0.265867f, 0.146428f });
    expect_colour("rec709.exr", { 0.5f, 0.25f, 0.125f });
    EXPECT_EQ(attribute("rec709.exr", "colorInteropID"), "lin_rec709_scene");
    EXPECT_THAT(attribute("rec709.exr", "chromaticities"), HasSubstr("0.64"));
    // Read again it is the same light: its label says so.
    done("makelightmap vm.exr acescg.exr" + config + "-o a.exr");
    done("makelightmap vm.exr rec709.exr" + config + "-o b.exr");
    expect_same_pixels("a.exr", "b.exr", 1e-5f);
    EXPECT_EQ(attribute("b.exr", "colorInteropID"), "lin_ap1_scene");
    done("makelightmap vm.exr sky_lin_rec709.exr" + config + "--output-colorspace 'Linear Rec.709 (sRGB)' -o c.exr");
    expect_colour("c.exr", { 0.5f, 0.25f, 0.125f });
    EXPECT_EQ(attribute("c.exr", "colorInteropID"), "lin_rec709_scene");
    // A space that the config does not have; and without a config.
    done("makelightmap vm.exr acescg.exr" + config + "--output-colorspace lin_p3d65_scene -o p3.exr");
    expect_colour("p3.exr", { 0.455616f, 0.258299f, 0.140456f });
    EXPECT_EQ(attribute("p3.exr", "colorInteropID"), "lin_p3d65_scene");
    done("makelightmap vm.exr acescg.exr --output-colorspace lin_rec709_scene -o x.exr");
    expect_colour("x.exr", { 0.5f, 0.25f, 0.125f });
    // A recipe gives the same, and can be read by others.
    write("x.lightmap", "vismap = \"vm.exr\"\ncfem = \"acescg.exr\"\noutput_colorspace = \"lin_rec709_scene\"\n");
    done("makelightmap x.lightmap" + config + "-o d.exr");
    expect_colour("d.exr", { 0.5f, 0.25f, 0.125f });
    refused(1, "is not linear, but light is scene-linear",
            "makecfem sky_lin_rec709.exr" + config + "--output-colorspace 'sRGB - Texture' -o x2.exr");
    refused(1, "is data, but light is scene-linear",
            "makecfem sky_lin_rec709.exr" + config + "--output-colorspace Raw -o x2.exr");
    refused(1, "did you mean \"ACEScg\"?",
            "makecfem sky_lin_rec709.exr" + config + "--output-colorspace ACEScgg -o x2.exr");
}

TEST_F(LightFiles, ACfemOfAnotherSpaceMeetsTheAlbedoInOne)
{
    make_vismap();
    make_sky({ 0.5f, 0.25f, 0.125f }, "sky_lin_rec709.exr");
    done("makecfem sky_lin_rec709.exr --colorconfig {config} -o cfem.exr");
    make_image("albedo_lin_rec709.exr", { "R", "G", "B" }, { 0.5f, 0.5f, 0.5f });
    // Grey is grey in any space, and the light keeps its own without a config.
    done("makelightmap vm.exr cfem.exr --albedo albedo_lin_rec709.exr -o lit.exr");
    EXPECT_EQ(attribute("lit.exr", "colorInteropID"), "lin_ap1_scene");
    expect_colour("lit.exr", { 0.198676f, 0.132933f, 0.073214f });
}

TEST_F(LightFiles, ACfemThatWasConvertedNamesTheFlag)
{
    make_vismap();
    done("makecfem {sky} --colorconfig {config} -o cfem.exr");
    OIIO::ImageBuf image(path("cfem.exr"));
    ASSERT_TRUE(image.read(0, 0, true, OIIO::TypeFloat));
    image.specmod().attribute("Software",
                              "OpenImageIO 2.4.7.1 : oiiotool cfem.exr --tocolorspace lin_rec709 -o stale.exr");
    ASSERT_TRUE(image.write(path("stale.exr"))) << image.geterror();
    refused(1, "shows a colour conversion (--tocolorspace), which leaves the colorInteropID \"lin_ap1_scene\"",
            "makelightmap vm.exr stale.exr -o x.exr");
    done("makelightmap vm.exr stale.exr --colorspace lin_ap1_scene -o x.exr");
}

TEST_F(LightFiles, TheConfigHasTheNamesThatOthersAskFor)
{
    const OIIO::ColorConfig config(kConfig);
    const std::pair<const char*, const char*> aliases[] {
        { "Utility - Raw", "Raw" },    { "Non-Color", "Raw" }, { "Utility - Linear - sRGB", "Linear Rec.709 (sRGB)" },
        { "ACES - ACEScg", "ACEScg" }, { "Linear", "ACEScg" }, { "Utility - sRGB - Texture", "sRGB - Texture" },
        { "sRGB", "sRGB - Texture" }
    };
    for (const auto& [alias, space] : aliases)
        EXPECT_STREQ(config.getColorSpaceNameByRole(alias), space) << alias;
    std::string text;
    ASSERT_TRUE(OIIO::Filesystem::read_text_file(kConfig, text));
    EXPECT_THAT(text, Not(HasSubstr("interop_id:")));
}
