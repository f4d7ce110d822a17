// SPDX-License-Identifier: Apache-2.0
// Suns of a lightmap that a host reads by the tile: traced, stored in the visibility map, or left in the environment.
#include "stage_scene.h"
#include "sun_sky.h"

#include <vmlight/base/format.h>
#include <vmlight/stage/open_source.h>
#include <vmlight/vismap/sun_visibility.h>

using namespace vmlight;
using namespace stage_scene;

namespace {

// The object of stage_scene.h, under two suns.
class SunnyFolder : public Folder
{
public:
    SunnyFolder()
    {
        const sun_sky::Sky sky { sun_sky::gray_sky,
                                 { { sun_sky::at_angles(20, 50), 1, Imath::V3d(9, 8, 6) },
                                   { sun_sky::at_angles(-120, 35), 2, Imath::V3d(5, 6, 9) } } };
        OIIO::ImageBuf image(OIIO::ImageSpec(128, 64, 3, OIIO::TypeFloat));
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 128; ++x) {
                const Imath::V3f rgb(sky.at(x, y, 128, 64));
                image.setpixel(x, y, &rgb.x);
            }
        EXPECT_TRUE(image.write(*this / "sunny.exr")) << image.geterror();
        SunSplit split;
        std::string error;
        std::vector<Disc> discs;
        EXPECT_TRUE(split.find(image, false, error)) << error;
        EXPECT_EQ(split.suns().size(), 2u);
        for (const Sun& sun : split.suns())
            discs.push_back(sun.disc);
        write("traced.vismap", bytes("hero.vismap") + "margin = 0\n");
        write("stored.vismap", bytes("traced.vismap") + "sun_directions = \"" + sun_directions_text(discs) + "\"\n");
        OIIO::ImageBuf map = vismap();
        EXPECT_TRUE(map.write(*this / "map.exr")) << map.geterror();
    }

    PixelSourcePointer lightmap(const std::string& vismap, const std::string& suns) const
    {
        write("sunny.lightmap", format("vismap = \"{}\"\nenvironment = \"sunny.exr\"\nsuns = \"{}\"\n", vismap, suns));
        std::string error;
        PixelSourcePointer source = open_source(*this / "sunny.lightmap", error);
        EXPECT_TRUE(source) << error;
        return source;
    }
};

std::vector<float> read_light(PixelSource& source)
{
    std::vector<float> pixels(size_t(source.spec().image_pixels()) * size_t(source.spec().nchannels), -1.0f);
    std::string error;
    EXPECT_TRUE(source.read(OIIO::get_roi(source.spec()), pixels.data(), error)) << error;
    return pixels;
}

OIIO::ImageBuf made_light(PixelSource& source)
{
    std::vector<OIIO::ImageBuf> images;
    std::string error;
    EXPECT_TRUE(source.make(images, {}, {}, error)) << error;
    return images.empty() ? OIIO::ImageBuf() : images[0];
}

} // namespace

TEST(WholeLight, ReadByTheTileOrMadeWholeItIsTheSame)
{
    const SunnyFolder folder;
    for (const char* map : { "hero.vismap", "traced.vismap", "stored.vismap" }) {
        const PixelSourcePointer source = folder.lightmap(map, "auto");
        ASSERT_TRUE(source);
        EXPECT_EQ(all_pixels(made_light(*source)), read_light(*source)) << map;
    }
}

TEST(WholeLight, StoredSunsAreThoseThatAreTraced)
{
    const SunnyFolder folder;
    const PixelSourcePointer traced = folder.lightmap("traced.vismap", "auto");
    const std::vector<float> a = read_light(*traced);
    const PixelSourcePointer stored = folder.lightmap("stored.vismap", "auto");
    const std::vector<float> b = read_light(*stored);
    ASSERT_EQ(a.size(), b.size());
    double squares = 0, sum = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        squares += std::pow(double(a[i]) - double(b[i]), 2);
        sum += std::pow(double(a[i]), 2);
    }
    EXPECT_LT(std::sqrt(squares / sum), 0.02);
}

// A host shows the picture, and has no place for a warning.
TEST(WholeLight, ItsMetadataSayWhySunsStayInTheEnvironment)
{
    const SunnyFolder folder;
    const std::string reason
        = "\"map.exr\" does not store its mesh: set --mesh, and --occluder for each mesh that occluded it";
    const PixelSourcePointer without = folder.lightmap(folder / "map.exr", "auto");
    ASSERT_TRUE(without);
    EXPECT_EQ(without->spec().get_string_attribute("vmlight:no_suns"), reason);
    EXPECT_EQ(made_light(*without).spec().get_string_attribute("vmlight:no_suns"), reason);
    for (const auto& [map, suns] : { std::pair("hero.vismap", "auto"), std::pair("map.exr", "off") }) {
        const PixelSourcePointer source = folder.lightmap(map, suns);
        ASSERT_TRUE(source);
        EXPECT_FALSE(source->spec().find_attribute("vmlight:no_suns")) << map;
        EXPECT_FALSE(made_light(*source).spec().find_attribute("vmlight:no_suns")) << map;
    }
}
