// SPDX-License-Identifier: Apache-2.0
#include "cfem_maps.h"
#include "temporary_folder.h"

#include <vmlight/cfem/stack.h>
#include <vmlight/stage/stored_image.h>
#include <vmlight/stage/streamed_environment.h>

#include <OpenImageIO/imagebufalgo.h>

using namespace cfem_maps;

namespace {

// Channels out of order, pixels that do not fill the display window, more rows than a strip.
OIIO::ImageBuf odd_image(int channels)
{
    OIIO::ImageSpec spec(150, 130, channels, OIIO::TypeFloat);
    spec.y = 9;
    spec.x = 3;
    spec.full_width = 160;
    spec.full_height = 150;
    if (channels == 4)
        spec.channelnames = { "A", "B", "G", "R" };
    OIIO::ImageBuf image(spec);
    std::mt19937 random(6);
    for (OIIO::ImageBuf::Iterator<float> p(image); !p.done(); ++p)
        for (int c = 0; c < channels; ++c)
            p[c] = float(random() % 1000) / 500;
    return image;
}

PixelSourcePointer opened(const std::string& path)
{
    std::string error;
    const PixelSourcePointer file = open_stored_image(path, error);
    EXPECT_TRUE(file) << error;
    return file;
}

// Whole in memory, and by rows.
std::pair<std::vector<OIIO::ImageBuf>, std::vector<OIIO::ImageBuf>> filtered_both_ways(const std::string& path,
                                                                                       const std::string& space)
{
    const ColorSettings settings { VMLIGHT_TEST_OCIO, space };
    std::string note, note_by_rows, error;
    OIIO::ImageBuf whole;
    const PixelSourcePointer file = opened(path);
    EXPECT_TRUE(read_all(whole, *file, error) && to_scene_linear(whole, path, settings, note, error)) << error;
    std::optional<Environment> by_rows;
    EXPECT_TRUE(stream_environment(by_rows, file, path, settings, note_by_rows, error)) << error;
    EXPECT_EQ(note, note_by_rows);
    std::vector<OIIO::ImageBuf> a, b;
    EXPECT_TRUE(make_cfem_stack(a, whole, exact(16, 8), error)) << error;
    EXPECT_TRUE(make_cfem_stack(b, *by_rows, exact(16, 8), error)) << error;
    return { std::move(a), std::move(b) };
}

} // namespace

TEST(StoredEnvironment, ReadAsItGoesItIsTheWholeToTheLastBit)
{
    const TemporaryFolder folder;
    for (int channels : { 1, 4 })
        for (const char* space : { "", "srgb_rec709_scene", "lin_rec709_scene" }) {
            const std::string path = folder / (std::to_string(channels) + space + ".exr");
            ASSERT_TRUE(odd_image(channels).write(path));
            const auto [whole, by_rows] = filtered_both_ways(path, space);
            ASSERT_EQ(whole.size(), by_rows.size());
            for (size_t i = 0; i < whole.size(); ++i) {
                EXPECT_EQ(OIIO::ImageBufAlgo::computePixelHashSHA1(whole[i]),
                          OIIO::ImageBufAlgo::computePixelHashSHA1(by_rows[i]))
                    << path << ", image " << i;
                EXPECT_EQ(whole[i].spec().get_string_attribute("colorInteropID"),
                          by_rows[i].spec().get_string_attribute("colorInteropID"));
            }
        }
}

TEST(StoredEnvironment, FaultsAreThoseOfTheWhole)
{
    const TemporaryFolder folder;
    OIIO::ImageBuf image = odd_image(4);
    const float bad[4] { 1, 1, NAN, 1 };
    image.setpixel(20, 30, 0, bad);
    const std::string path = folder / "bad.exr";
    ASSERT_TRUE(image.write(path));
    std::optional<Environment> by_rows;
    std::string note, error;
    OIIO::ImageBuf dst;
    ASSERT_TRUE(stream_environment(by_rows, opened(path), path, {}, note, error)) << error;
    EXPECT_FALSE(make_cfem(dst, *by_rows, exact(4, 2)));
    EXPECT_EQ(dst.geterror(), refusal(OIIO::ImageBuf(path)));

    OIIO::ImageSpec depth(4, 2, 2, OIIO::TypeFloat);
    depth.channelnames = { "Z", "A" };
    ASSERT_TRUE(OIIO::ImageBuf(depth).write(folder / "depth.exr"));
    EXPECT_FALSE(stream_environment(by_rows, opened(folder / "depth.exr"), "depth.exr", {}, note, error));
    EXPECT_EQ(error.rfind("\"depth.exr\": ", 0), 0u) << error;
}

TEST(StoredEnvironment, WhatTakesMoreThanAQuarterGibibyteIsLarge)
{
    EXPECT_TRUE(is_too_large_to_hold(OIIO::ImageSpec(8192, 4096, 3, OIIO::TypeHalf)));
    EXPECT_FALSE(is_too_large_to_hold(OIIO::ImageSpec(4096, 2048, 4, OIIO::TypeFloat)));
}
