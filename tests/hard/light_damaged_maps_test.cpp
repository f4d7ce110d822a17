// SPDX-License-Identifier: Apache-2.0
// Stored visibility maps that something filtered, compressed or converted on the way.
#include "hard_case.h"

#include "error_scenes.h"
#include "lightmap_scene.h"
#include "temporary_folder.h"

#include <vmlight/base/oiio_compat.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/stage/open_source.h>

#include <OpenImageIO/imageio.h>

#include <array>

using namespace vmlight;
using OIIO::ImageBuf;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

namespace {

ImageBuf spot_map()
{
    VismapParams params;
    params.resolution = { 256, 256 };
    params.samples = 32;
    ImageBuf map;
    EXPECT_TRUE(make_vismap(map, scenes::test_mesh("spot.obj"), {}, params)) << map.geterror();
    return map;
}

// What lighting a map that is stored so has to say, and whether the tile by tile path agrees.
class DamagedMaps
{
public:
    DamagedMaps()
    {
        ImageBuf sky = scene::cfem(8, 4, [](Imath::V3d) { return Imath::V3f(1); });
        EXPECT_TRUE(sky.write(m_folder / "sky.exr"));
        m_recipe.environment = m_folder / "sky.exr";
        m_recipe.vismap = m_folder / "map.exr";
    }

    // "", the warning, or "refused: " and the reason.
    std::string verdict(const ImageBuf& map, TypeDesc format = TypeDesc::FLOAT, const char* compression = "zip")
    {
        ImageSpec spec = map.spec();
        spec.set_format(format);
        spec.attribute("compression", compression);
        const auto out = OIIO::ImageOutput::create("openexr");
        EXPECT_TRUE(out->open(m_recipe.vismap, spec) && out->write_image(TypeDesc::FLOAT, map.localpixels())
                    && out->close())
            << out->geterror();
        std::string warnings;
        MakeOptions options;
        options.warn = [&](const std::string& line) { warnings += line; };
        ImageBuf lit;
        const bool made = make_image(lit, m_recipe, options);
        std::string error;
        const PixelSourcePointer source = open_source(m_recipe, error, {}, Sharing::none);
        std::vector<float> pixels(3 * spec.image_pixels());
        if (source && made) {
            EXPECT_TRUE(source->read(map.roi(), pixels.data(), error)) << error;
        } else if (source && lit.geterror(false).find("cannot be visibility") != std::string::npos) {
            EXPECT_FALSE(source->read(map.roi(), pixels.data(), error));
        }
        return made ? warnings : "refused: " + lit.geterror();
    }

private:
    const TemporaryFolder m_folder;
    LightmapRecipe m_recipe;
};

ImageBuf resized(const ImageBuf& map, const char* filter, int side)
{
    ImageBuf result;
    oiio::resize(result, map, OIIO::ROI(0, side, 0, side, 0, 1, 0, map.nchannels()), 0, filter);
    return result;
}

template <class Convert> ImageBuf converted(ImageBuf map, const Convert& convert)
{
    for (int i = 0; i < int(map.spec().image_pixels()); ++i) {
        Imath::V3f& b
            = *reinterpret_cast<Imath::V3f*>(static_cast<float*>(map.localpixels()) + i * map.nchannels() + 1);
        b = convert(b);
    }
    return map;
}

float to_linear(float x)
{
    const float a = std::abs(x);
    return std::copysign(a <= 0.04045f ? a / 12.92f : std::pow((a + 0.055f) / 1.055f, 2.4f), x);
}

float to_srgb(float x)
{
    const float a = std::abs(x);
    return std::copysign(a <= 0.0031308f ? a * 12.92f : 1.055f * std::pow(a, 1 / 2.4f) - 0.055f, x);
}

// Linear Rec.709 to ACEScg, row vectors.
const Imath::M33f kToAp1(0.6131f, 0.0702f, 0.0206f, 0.3395f, 0.9164f, 0.1096f, 0.0474f, 0.0135f, 0.8698f);

} // namespace

TEST(Light, MapsThatAFilterLeftRinging)
{
    HardCase row(
        "A visibility map at half its size by lanczos3, sinc, catmull-rom and mitchell; by a box, down to 1/8; as "
        "half; by pxr24, dwaa and dwab",
        "oiiotool --resize: lanczos3 by default");
    const ImageBuf map = spot_map();
    DamagedMaps maps;
    float lowest = 0;
    for (const char* const filter : { "lanczos3", "sinc", "catmull-rom", "mitchell" }) {
        const ImageBuf ringing = resized(map, filter, 128);
        for (const TypeDesc format : { TypeDesc::FLOAT, TypeDesc::HALF }) {
            const std::string said = maps.verdict(ringing, format);
            EXPECT_EQ(said.rfind("refused: ", 0), 0u) << filter << ": " << said;
            EXPECT_NE(said.find("cannot be visibility, the first at ("), std::string::npos) << said;
            EXPECT_NE(said.find("resized by a filter that rings"), std::string::npos) << said;
        }
        for (int i = 0; i < 128 * 128; ++i)
            lowest = std::min(lowest, scene::pixels(ringing)[4 * i]);
    }
    EXPECT_LT(lowest, -0.1f);
    row.naive("V below -0.1, lit as it is");
    EXPECT_EQ(maps.verdict(map), "");
    EXPECT_EQ(maps.verdict(map, TypeDesc::HALF), "");
    EXPECT_EQ(maps.verdict(map, TypeDesc::HALF, "dwaa"), "");
    EXPECT_EQ(maps.verdict(map, TypeDesc::HALF, "dwab"), "");
    EXPECT_EQ(maps.verdict(map, TypeDesc::FLOAT, "pxr24"), "");
    ImageBuf mip = map;
    for (int side = 128; side >= 32; side /= 2) {
        mip = resized(mip, "box", side);
        EXPECT_EQ(maps.verdict(mip, TypeDesc::HALF), "") << side;
    }
    EXPECT_EQ(maps.verdict(resized(map, "triangle", 128), TypeDesc::HALF), "");
    row.ours("those that ring are refused, with how many texels and where; the others are lit without a word");
}

TEST(Light, AMapWithOneTexelThatIsNoVisibility)
{
    HardCase row("A visibility map with V = 1.2 in one texel of 65536");
    row.naive("lit as it is");
    ImageBuf map = spot_map();
    int x = 0, y = 64;
    while (map.getchannel(x, y, 0, 0) == 0)
        ++x;
    map.setpixel(x, y, std::array<float, 4> { 1.2f, 0, 0, 0.7f }.data(), 4);
    const std::string said = DamagedMaps().verdict(map);
    EXPECT_EQ(said.find("refused"), std::string::npos) << said;
    EXPECT_NE(said.find("1 of "), std::string::npos) << said;
    EXPECT_NE(said.find("cannot be visibility, at (" + std::to_string(x) + ", 64): V is outside [0, 1]"),
              std::string::npos)
        << said;
    row.ours("lit, with a warning that says where");
}

TEST(Light, MapsThatWereConvertedAsColour)
{
    HardCase row(
        "A visibility map whose B went through an sRGB curve, or from Rec.709 to ACEScg, either way, without a trace "
        "in its metadata",
        "maketx --colorconvert of OIIO 3.1: no trace");
    const ImageBuf map = spot_map();
    DamagedMaps maps;
    row.naive("lit from wrong directions");
    const auto curve
        = [](float (*f)(float)) { return [f](const Imath::V3f& b) { return Imath::V3f(f(b.x), f(b.y), f(b.z)); }; };
    std::string said = maps.verdict(converted(map, curve(to_srgb)));
    EXPECT_NE(said.find("cannot be visibility"), std::string::npos) << said;
    said = maps.verdict(converted(map, [](const Imath::V3f& b) { return b * kToAp1.inverse(); }));
    EXPECT_NE(said.find("cannot be visibility"), std::string::npos) << said;
    said = maps.verdict(converted(map, curve(to_linear)));
    EXPECT_EQ(said.rfind("refused: ", 0), 0u) << said;
    EXPECT_NE(said.find("was converted as if it were colour"), std::string::npos) << said;
    // Little shorter, and turned by a few degrees.
    said = maps.verdict(converted(map, [](const Imath::V3f& b) { return b * kToAp1; }));
    EXPECT_NE(said.find("was the map converted as if it were colour?"), std::string::npos) << said;
    row.ours("refused; to ACEScg: warned of");
}

TEST(Light, AMapStoredWithB44)
{
    HardCase row("A visibility map stored as half with b44 and b44a");
    const ImageBuf map = spot_map();
    DamagedMaps maps;
    row.naive("opens closed texels, turns B by up to 14 degrees (measured)");
    for (const char* const compression : { "b44", "b44a" }) {
        const std::string said = maps.verdict(map, TypeDesc::HALF, compression);
        EXPECT_NE(said.find(std::string("stored as half with the compression ") + compression), std::string::npos)
            << said;
        EXPECT_EQ(maps.verdict(map, TypeDesc::FLOAT, compression), ""); // leaves floats alone
    }
    row.ours("a warning, or refused where it shows");
}
