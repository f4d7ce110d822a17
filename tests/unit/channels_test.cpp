// SPDX-License-Identifier: Apache-2.0
/// The image contract: what is taken for a visibility map, and what is one no more.
#include <vmlight/image/channels.h>

#include <gtest/gtest.h>

using namespace vmlight;

namespace {

OIIO::ImageSpec vismap_spec()
{
    OIIO::ImageSpec spec(4, 4, 4, OIIO::TypeFloat);
    spec.channelnames = { "direction.x", "direction.y", "direction.z", "visibility" };
    spec.attribute("vmlight:stage", kVismapStage);
    spec.attribute("colorInteropID", "data");
    return spec;
}

std::string fault_of(const OIIO::ImageSpec& spec)
{
    std::array<int, 4> index;
    std::string error;
    return find_vismap_channels(spec, index, error) ? "none" : error;
}

} // namespace

TEST(Channels, AVisibilityMapIsKnownByNames)
{
    std::array<int, 4> index {};
    std::string error;
    EXPECT_TRUE(find_vismap_channels(vismap_spec(), index, error)) << error;
    EXPECT_EQ(index, (std::array<int, 4> { 3, 0, 1, 2 }));
    OIIO::ImageSpec spec = vismap_spec();
    spec.erase_attribute("vmlight:stage");
    spec.erase_attribute("colorInteropID");
    EXPECT_EQ(fault_of(spec), "none");
    spec.channelnames[3] = "A";
    EXPECT_NE(fault_of(spec).find("no channel \"visibility\" among"), std::string::npos);
    EXPECT_EQ(fault_of(spec).find("maketx"), std::string::npos);
}

TEST(Channels, NamesThatATextureLostAreExplained)
{
    OIIO::ImageSpec spec(8, 8, 4, OIIO::TypeFloat);
    spec.attribute("textureformat", "Plain Texture"); // as maketx writes
    EXPECT_NE(fault_of(spec).find("--format exr"), std::string::npos) << fault_of(spec);
    EXPECT_EQ(fault_of(OIIO::ImageSpec(8, 8, 4, OIIO::TypeFloat)).find("--format exr"), std::string::npos);
}

TEST(Channels, AMapThatWasConvertedAsColourIsNoVisibilityMapAnyMore)
{
    for (const char* command : { "maketx --colorconvert sRGB ACEScg a.exr -o b.exr", "oiiotool a.exr --tocolorspace x",
                                 "oiiotool a.exr --ociodisplay d v", "oiiotool a.exr --ociofiletransform x.lut" }) {
        OIIO::ImageSpec spec = vismap_spec();
        spec.attribute("Software", std::string("OpenImageIO 2.4.7.1 : ") + command);
        EXPECT_NE(fault_of(spec).find("no longer a visibility map"), std::string::npos) << command;
    }
    for (const char* command : { "maketx a.exr -o b.exr", "oiiotool --autocc a.exr --resize 2x2 -o b.exr" }) {
        OIIO::ImageSpec spec = vismap_spec();
        spec.attribute("Software", std::string("OpenImageIO 2.4.7.1 : ") + command);
        EXPECT_EQ(fault_of(spec), "none") << command;
    }
    OIIO::ImageSpec spec = vismap_spec();
    spec.attribute("colorInteropID", "lin_ap1_scene");
    EXPECT_NE(fault_of(spec).find("tagged as colour, \"lin_ap1_scene\""), std::string::npos);
}
