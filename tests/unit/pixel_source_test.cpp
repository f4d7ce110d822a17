// SPDX-License-Identifier: Apache-2.0
// A source made whole, as the executables do, and read by the tile, as the readers do.
#include "stage_scene.h"

#include <vmlight/base/format.h>
#include <vmlight/cfem/stack.h>
#include <vmlight/stage/open_source.h>
#include <vmlight/stage/stored_image.h>

#include <chrono>

using namespace vmlight;
using namespace stage_scene;

namespace {

std::vector<OIIO::ImageBuf> all_made(PixelSource& source, ImageRange range = {})
{
    std::vector<OIIO::ImageBuf> images;
    std::string error;
    EXPECT_TRUE(source.make(images, range, {}, error)) << error;
    EXPECT_EQ(int(images.size()), range.count);
    return images;
}

std::vector<float> read_level(PixelSource& source, int image = 0)
{
    const OIIO::ImageSpec& spec = source.spec_of(image);
    std::vector<float> pixels(size_t(spec.image_pixels()) * spec.nchannels, -1.0f);
    std::string error;
    EXPECT_TRUE(source.read_of(image, OIIO::get_roi(spec), pixels.data(), error)) << error;
    return pixels;
}

PixelSourcePointer opened_source(const std::string& name)
{
    std::string error;
    PixelSourcePointer source = open_source(name, error);
    EXPECT_TRUE(source) << error;
    return source;
}

} // namespace

TEST(PixelSource, MadeWholeOrReadByTheTileItIsTheSame)
{
    const Folder folder;
    for (const std::string& name :
         { folder / "hero.vismap", folder / "hero.vismap?basis=cells&channels=coverage", folder / "studio.cfem",
           folder / "hero.lightmap", folder / "hero.lightmap?albedo=" + (folder / "studio.exr"),
           folder / "studio.exr" }) {
        const PixelSourcePointer source = opened_source(name);
        ASSERT_TRUE(source);
        EXPECT_EQ(all_pixels(all_made(*source)[0]), read_level(*source)) << name;
    }
}

TEST(PixelSource, OfAStackItMakesTheImagesThatAreAskedFor)
{
    const Folder folder;
    const PixelSourcePointer stack = opened_source(folder / "studio.cfem?stack=true");
    ASSERT_EQ(stack->subimages(), kStackImages);
    for (const ImageRange range :
         { ImageRange { 0, 1 }, { 0, kStackLevels }, { kStackLevels, 1 }, { 0, kStackImages } }) {
        const std::vector<OIIO::ImageBuf> images = all_made(*stack, range);
        for (int i = 0; i < range.count; ++i)
            EXPECT_EQ(all_pixels(images[size_t(i)]), read_level(*stack, range.first + i)) << range.first << " " << i;
    }
}

// A bake may take an hour, in which a backup touches the inputs that are read after it.
TEST(PixelSource, AFileThatWasOnlyTouchedIsMadeAndOneOfAnotherSizeRefused)
{
    const Folder folder;
    const std::string path = folder / "studio.exr";
    const PixelSourcePointer source = opened_source(path);
    const std::vector<float> before = read_level(*source);
    std::filesystem::last_write_time(path, std::filesystem::last_write_time(path) + std::chrono::seconds(5));
    EXPECT_EQ(all_pixels(all_made(*source)[0]), before);
    OIIO::ImageBuf unread;
    std::string error;
    EXPECT_FALSE(read_all(unread, *source, error)) << "readers promise the file as it was";

    ASSERT_TRUE(OIIO::ImageBuf(OIIO::ImageSpec(8, 4, 3, OIIO::TypeFloat)).write(path));
    std::vector<OIIO::ImageBuf> images;
    error.clear();
    EXPECT_FALSE(source->make(images, {}, {}, error));
    EXPECT_EQ(error, format("\"{}\": changed since it was opened", path));
}
