// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/source_cache.h>
/// What readers keep between opens and when they let go of it; files that are damaged, or that hold a host up.
#include "stage_scene.h"
#include <vmlight/stage/source_cache.h>

#include <OpenImageIO/parallel.h>
#include <vmlight/stage/source_cache.h>

#include <array>
#include <cstring>
#include <map>
#include <vmlight/stage/source_cache.h>

#include <sys/stat.h>
#include <vmlight/stage/source_cache.h>

#include <vmlight/stage/source_cache.h>
using namespace vmlight;
#include <vmlight/stage/source_cache.h>
using namespace stage_scene;
#include <vmlight/stage/source_cache.h>
using OIIO::ImageBuf;
#include <vmlight/stage/source_cache.h>
using OIIO::ImageInput;
#include <vmlight/stage/source_cache.h>

#include <vmlight/stage/source_cache.h>
namespace {
#include <vmlight/stage/source_cache.h>

#include <vmlight/stage/source_cache.h>
bool read_tile(const std::string& name, int x, int y, std::vector<float>& tile, std::string& error)
#include <vmlight/stage/source_cache.h>
{
#include <vmlight/stage/source_cache.h>
    const auto input = ImageInput::open(name);
#include <vmlight/stage/source_cache.h>
    if (!input) {
#include <vmlight/stage/source_cache.h>
        error = OIIO::geterror();
#include <vmlight/stage/source_cache.h>
        return false;
#include <vmlight/stage/source_cache.h>
    }
#include <vmlight/stage/source_cache.h>
    tile.assign(size_t(64) * 64 * input->spec().nchannels, -1.0f);
#include <vmlight/stage/source_cache.h>
    const bool good = input->read_tile(x, y, 0, OIIO::TypeFloat, tile.data());
#include <vmlight/stage/source_cache.h>
    error = good ? "" : input->geterror();
#include <vmlight/stage/source_cache.h>
    return good;
#include <vmlight/stage/source_cache.h>
}
#include <vmlight/stage/source_cache.h>

#include <vmlight/stage/source_cache.h>
// A square facing +z, or +y, over the whole texture, in two files.
#include <vmlight/stage/source_cache.h>
void write_gltf(const Folder& folder, bool up)
#include <vmlight/stage/source_cache.h>
{
#include <vmlight/stage/source_cache.h>
    const float positions[12]
#include <vmlight/stage/source_cache.h>
        = { 0, 0, 0, 1, 0, 0, 1, up ? 0.f : 1.f, up ? -1.f : 0.f, 0, up ? 0.f : 1.f, up ? -1.f : 0.f };
#include <vmlight/stage/source_cache.h>
    const float normal[3] = { 0, up ? 1.f : 0.f, up ? 0.f : 1.f }, uvs[8] = { 0, 1, 1, 1, 1, 0, 0, 0 };
#include <vmlight/stage/source_cache.h>
    const uint16_t indices[6] = { 0, 1, 2, 0, 2, 3 };
#include <vmlight/stage/source_cache.h>
    std::string bytes(reinterpret_cast<const char*>(positions), 48);
#include <vmlight/stage/source_cache.h>
    for (int i = 0; i < 4; ++i)
#include <vmlight/stage/source_cache.h>
        bytes.append(reinterpret_cast<const char*>(normal), 12);
#include <vmlight/stage/source_cache.h>
    bytes.append(reinterpret_cast<const char*>(uvs), 32);
#include <vmlight/stage/source_cache.h>
    bytes.append(reinterpret_cast<const char*>(indices), 12);
#include <vmlight/stage/source_cache.h>
    folder.write("square.bin", bytes);
#include <vmlight/stage/source_cache.h>
    if (std::filesystem::exists(folder / "square.gltf"))
#include <vmlight/stage/source_cache.h>
        return;
#include <vmlight/stage/source_cache.h>
    folder.write("square.gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
#include <vmlight/stage/source_cache.h>
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3}]}],
#include <vmlight/stage/source_cache.h>
"buffers":[{"uri":"square.bin","byteLength":140}],
#include <vmlight/stage/source_cache.h>
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":48},
#include <vmlight/stage/source_cache.h>
{"buffer":0,"byteOffset":96,"byteLength":32},{"buffer":0,"byteOffset":128,"byteLength":12}],
#include <vmlight/stage/source_cache.h>
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,-1],"max":[1,1,0]},
#include <vmlight/stage/source_cache.h>
{"bufferView":1,"componentType":5126,"count":4,"type":"VEC3"},{"bufferView":2,"componentType":5126,"count":4,"type":"VEC2"},
#include <vmlight/stage/source_cache.h>
{"bufferView":3,"componentType":5123,"count":6,"type":"SCALAR"}]})");
#include <vmlight/stage/source_cache.h>
}
#include <vmlight/stage/source_cache.h>

#include <vmlight/stage/source_cache.h>
} // namespace
#include <vmlight/stage/source_cache.h>

#include <vmlight/stage/source_cache.h>
// A thread that waits for OIIO's pool runs what is queued there meanwhile: here, tiles of the very image that it is
#include <vmlight/stage/source_cache.h>
// about to prepare.
#include <vmlight/stage/source_cache.h>
TEST(StageState, AThreadOfTheHostNeverWaitsForItself)
#include <vmlight/stage/source_cache.h>
{
#include <vmlight/stage/source_cache.h>
    const Folder folder;
#include <vmlight/stage/source_cache.h>
    ASSERT_TRUE(folder.vismap().write(folder / "vm.exr"));
#include <vmlight/stage/source_cache.h>
    ImageBuf albedo(OIIO::ImageSpec(37, 53, 3, OIIO::TypeFloat));
#include <vmlight/stage/source_cache.h>
    OIIO::ImageBufAlgo::noise(albedo, "uniform", 0.1f, 0.9f, false, 1);
#include <vmlight/stage/source_cache.h>
    ASSERT_TRUE(albedo.write(folder / "albedo.exr"));
#include <vmlight/stage/source_cache.h>
    folder.write("large.cfem", "environment = \"studio.exr\"\nresolution = 512\n");
#include <vmlight/stage/source_cache.h>
    folder.write("a.lightmap", "vismap = \"vm.exr\"\ncfem = \"studio.cfem\"\nalbedo = \"albedo.exr\"\n");
#include <vmlight/stage/source_cache.h>
    folder.write("b.lightmap", "vismap = \"vm.exr\"\ncfem = \"large.cfem\"\n");
#include <vmlight/stage/source_cache.h>
    for (int angle = 0; angle < 30; ++angle)
#include <vmlight/stage/source_cache.h>
        for (const char* name : { "a", "b" }) {
#include <vmlight/stage/source_cache.h>
            if (name[0] == 'b' && angle % 3 != 0)
#include <vmlight/stage/source_cache.h>
                continue; // filtering is slow under sanitizers
#include <vmlight/stage/source_cache.h>
            set_source_limits(1, 1); // so that each image prepares all it needs
#include <vmlight/stage/source_cache.h>
            const auto input
#include <vmlight/stage/source_cache.h>
                = ImageInput::open(folder / (std::string(name) + ".lightmap?rotate=0," + std::to_string(angle) + ",0"));
#include <vmlight/stage/source_cache.h>
            ASSERT_TRUE(input) << OIIO::geterror();
#include <vmlight/stage/source_cache.h>
            all_pixels(*input);
#include <vmlight/stage/source_cache.h>
        }
#include <vmlight/stage/source_cache.h>
    set_source_limits(size_t(1) << 30, 64);
#include <vmlight/stage/source_cache.h>
}
#include <vmlight/stage/source_cache.h>

#include <vmlight/stage/source_cache.h>
TEST(StageState, ADamagedMapIsAnErrorOnEveryReadOfEveryOpen)
#include <vmlight/stage/source_cache.h>
{
#include <vmlight/stage/source_cache.h>
    const Folder folder;
#include <vmlight/stage/source_cache.h>
    for (const bool tiled : { true, false }) {
#include <vmlight/stage/source_cache.h>
        ImageBuf vismap = folder.vismap();
#include <vmlight/stage/source_cache.h>
        vismap.specmod().attribute("compression", "none");
#include <vmlight/stage/source_cache.h>
        vismap.specmod().attribute("openexr:lineOrder", "increasingY");
#include <vmlight/stage/source_cache.h>
        if (tiled)
#include <vmlight/stage/source_cache.h>
            vismap.set_write_tiles(64, 64);
#include <vmlight/stage/source_cache.h>
        else
#include <vmlight/stage/source_cache.h>
            vismap.set_write_tiles(0, 0);
#include <vmlight/stage/source_cache.h>
        ASSERT_TRUE(vismap.write(folder / "vm.exr")) << vismap.geterror();
#include <vmlight/stage/source_cache.h>
        const std::string whole = folder.bytes("vm.exr");
#include <vmlight/stage/source_cache.h>
        folder.write("vm.exr", whole.substr(0, whole.size() - 60000));
#include <vmlight/stage/source_cache.h>
        folder.write("cut.lightmap", "vismap = \"vm.exr\"\ncfem = \"studio.cfem\"\n");
#include <vmlight/stage/source_cache.h>
        std::vector<float> tile;
#include <vmlight/stage/source_cache.h>
        std::string error;
#include <vmlight/stage/source_cache.h>
        EXPECT_TRUE(read_tile(folder / "cut.lightmap", 0, 0, tile, error)) << error;
#include <vmlight/stage/source_cache.h>
        for (int i = 0; i < 3; ++i)
#include <vmlight/stage/source_cache.h>
            for (int x : { 0, 64, 128, 192 }) {
#include <vmlight/stage/source_cache.h>
                if (tiled && x < 192)
#include <vmlight/stage/source_cache.h>
                    continue; // those of the last row that are there may be read
#include <vmlight/stage/source_cache.h>
                EXPECT_FALSE(read_tile(folder / "cut.lightmap", x, 128, tile, error)) << tiled << " " << i << " " << x;
#include <vmlight/stage/source_cache.h>
                EXPECT_NE(error.find("vm.exr\": "), std::string::npos) << error;
#include <vmlight/stage/source_cache.h>
            }
#include <vmlight/stage/source_cache.h>
    }
#include <vmlight/stage/source_cache.h>
}
#include <vmlight/stage/source_cache.h>

#include <vmlight/stage/source_cache.h>
TEST(StageState, AChangedBufferOfAMeshIsReadAnew)
#include <vmlight/stage/source_cache.h>
{
#include <vmlight/stage/source_cache.h>
    const Folder folder;
#include <vmlight/stage/source_cache.h>
    write_gltf(folder, false);
#include <vmlight/stage/source_cache.h>
    folder.write("square.vismap", "mesh = \"square.gltf\"\nresolution = 64\nsamples = 16\n");
#include <vmlight/stage/source_cache.h>
    folder.write("square.lightmap", "vismap = \"square.vismap\"\ncfem = \"studio.cfem\"\n");
#include <vmlight/stage/source_cache.h>
    std::vector<float> tile, lit, lit_again;
#include <vmlight/stage/source_cache.h>
    std::string error;
#include <vmlight/stage/source_cache.h>
    ASSERT_TRUE(read_tile(folder / "square.vismap", 0, 0, tile, error)) << error;
#include <vmlight/stage/source_cache.h>
    ASSERT_TRUE(read_tile(folder / "square.lightmap", 0, 0, lit, error)) << error;
#include <vmlight/stage/source_cache.h>
    EXPECT_NEAR(tile[3], 2.0 / 3, 1e-6);
#include <vmlight/stage/source_cache.h>
    write_gltf(folder, true);
#include <vmlight/stage/source_cache.h>
    ASSERT_TRUE(read_tile(folder / "square.vismap", 0, 0, tile, error)) << error;
#include <vmlight/stage/source_cache.h>
    ASSERT_TRUE(read_tile(folder / "square.lightmap", 0, 0, lit_again, error)) << error;
#include <vmlight/stage/source_cache.h>
    EXPECT_NEAR(tile[2], 2.0 / 3, 1e-6);
#include <vmlight/stage/source_cache.h>
    EXPECT_NE(lit, lit_again);
#include <vmlight/stage/source_cache.h>
}
#include <vmlight/stage/source_cache.h>

#include <vmlight/stage/source_cache.h>
TEST(StageState, ContentPutInPlaceWithSizeAndTimeKeptIsReadAnew)
#include <vmlight/stage/source_cache.h>
{
#include <vmlight/stage/source_cache.h>
    const Folder folder;
#include <vmlight/stage/source_cache.h>
    folder.write("sky.pfm", std::string("PF\n1 1\n-1.0\n") + std::string("\0\0\x80\x3f\0\0\x80\x3f\0\0\x80\x3f", 12));
#include <vmlight/stage/source_cache.h>
    folder.write("sky.cfem", "environment = \"sky.pfm\"\nresolution = 4\n");
#include <vmlight/stage/source_cache.h>
    const auto time = std::filesystem::last_write_time(folder / "sky.pfm");
#include <vmlight/stage/source_cache.h>
    EXPECT_FLOAT_EQ(all_pixels(*ImageInput::open(folder / "sky.cfem"))[0], 1);
#include <vmlight/stage/source_cache.h>
    folder.write("sky.pfm", std::string("PF\n1 1\n-1.0\n") + std::string("\0\0\0\x40\0\0\0\x40\0\0\0\x40", 12));
#include <vmlight/stage/source_cache.h>
    std::filesystem::last_write_time(folder / "sky.pfm", time);
#include <vmlight/stage/source_cache.h>
    EXPECT_FLOAT_EQ(all_pixels(*ImageInput::open(folder / "sky.cfem"))[0], 2);
#include <vmlight/stage/source_cache.h>
}
#include <vmlight/stage/source_cache.h>

#include <vmlight/stage/source_cache.h>
TEST(StageState, APipeIsNoInput)
#include <vmlight/stage/source_cache.h>
{
#include <vmlight/stage/source_cache.h>
    const Folder folder;
#include <vmlight/stage/source_cache.h>
    ASSERT_EQ(::mkfifo((folder / "pipe.exr").c_str(), 0600), 0);
#include <vmlight/stage/source_cache.h>
    folder.write("pipe.cfem", "environment = \"pipe.exr\"\n");
#include <vmlight/stage/source_cache.h>
    EXPECT_FALSE(ImageInput::open(folder / "pipe.cfem"));
#include <vmlight/stage/source_cache.h>
    EXPECT_NE(OIIO::geterror().find("pipe.exr\": not a file"), std::string::npos);
#include <vmlight/stage/source_cache.h>
}
#include <vmlight/stage/source_cache.h>

#include <vmlight/stage/source_cache.h>
TEST(StageState, WhatIsOpenIsFoundAgainHoweverLittleIsKept)
#include <vmlight/stage/source_cache.h>
{
#include <vmlight/stage/source_cache.h>
    const Folder folder;
#include <vmlight/stage/source_cache.h>
    const auto input = ImageInput::open(folder / "hero.lightmap");
#include <vmlight/stage/source_cache.h>
    const auto first = all_pixels(*input);
#include <vmlight/stage/source_cache.h>
    set_source_limits(1, 1);
#include <vmlight/stage/source_cache.h>
    folder.write("other.cfem", "environment = \"studio.exr\"\nresolution = 8\n");
#include <vmlight/stage/source_cache.h>
    EXPECT_TRUE(ImageInput::open(folder / "other.cfem")); // the one source that is kept
#include <vmlight/stage/source_cache.h>
    const Work before;
#include <vmlight/stage/source_cache.h>
    EXPECT_EQ(all_pixels(*ImageInput::open(folder / "hero.lightmap")), first);
#include <vmlight/stage/source_cache.h>
    EXPECT_EQ((Work() - before).meshes_read, 0);
#include <vmlight/stage/source_cache.h>
    EXPECT_EQ((Work() - before).cfems_made, 0);
#include <vmlight/stage/source_cache.h>
    set_source_limits(size_t(1) << 30, 64);
#include <vmlight/stage/source_cache.h>
}
#include <vmlight/stage/source_cache.h>

#include <vmlight/stage/source_cache.h>
TEST(StageState, RotationsShareTheConvertedAlbedo)
#include <vmlight/stage/source_cache.h>
{
#include <vmlight/stage/source_cache.h>
    const Folder folder;
#include <vmlight/stage/source_cache.h>
    ImageBuf albedo(OIIO::ImageSpec(20, 30, 3, OIIO::TypeUInt8));
#include <vmlight/stage/source_cache.h>
    OIIO::ImageBufAlgo::noise(albedo, "uniform", 0.1f, 0.9f, false, 1);
#include <vmlight/stage/source_cache.h>
    ASSERT_TRUE(albedo.write(folder / "paint.png"));
#include <vmlight/stage/source_cache.h>
    folder.write("painted.lightmap", "vismap = \"hero.vismap\"\ncfem = \"studio.cfem\"\nalbedo = \"paint.png\"\n");
#include <vmlight/stage/source_cache.h>
    const int64_t before = work_counts().albedos_made;
#include <vmlight/stage/source_cache.h>
    const auto one = all_pixels(*ImageInput::open(folder / "painted.lightmap?rotate=0,10,0"));
#include <vmlight/stage/source_cache.h>
    EXPECT_NE(all_pixels(*ImageInput::open(folder / "painted.lightmap?rotate=0,100,0")), one);
#include <vmlight/stage/source_cache.h>
    EXPECT_EQ(work_counts().albedos_made - before, 1);
#include <vmlight/stage/source_cache.h>
}
#include <vmlight/stage/source_cache.h>

#include <vmlight/stage/source_cache.h>
TEST(StageState, AConfigMattersOnlyWhereColourIsConverted)
#include <vmlight/stage/source_cache.h>
{
#include <vmlight/stage/source_cache.h>
    const Folder folder;
#include <vmlight/stage/source_cache.h>
    ASSERT_TRUE(folder.vismap().write(folder / "vm.exr"));
#include <vmlight/stage/source_cache.h>
    ASSERT_TRUE(folder.cfem().write(folder / "cfem.exr"));
#include <vmlight/stage/source_cache.h>
    folder.write("stored.lightmap", "vismap = \"vm.exr\"\ncfem = \"cfem.exr\"\ncolorconfig = \"gone.ocio\"\n");
#include <vmlight/stage/source_cache.h>
    folder.write("live.lightmap", "vismap = \"vm.exr\"\nenvironment = \"studio.exr\"\ncolorconfig = \"gone.ocio\"\n");
#include <vmlight/stage/source_cache.h>
    EXPECT_TRUE(ImageInput::open(folder / "stored.lightmap")) << OIIO::geterror();
#include <vmlight/stage/source_cache.h>
    EXPECT_FALSE(ImageInput::open(folder / "live.lightmap"));
#include <vmlight/stage/source_cache.h>
    EXPECT_NE(OIIO::geterror().find("gone.ocio\": no such file"), std::string::npos);
#include <vmlight/stage/source_cache.h>
}
#include <vmlight/stage/source_cache.h>

#include <vmlight/stage/source_cache.h>
TEST(StageState, AnInputMayBeAnImageThatAnotherReaderMakesFromItsName)
#include <vmlight/stage/source_cache.h>
{
#include <vmlight/stage/source_cache.h>
    const Folder folder;
#include <vmlight/stage/source_cache.h>
    folder.write("white.cfem",
#include <vmlight/stage/source_cache.h>
                 "environment = \"/x.null?RES=64x32&CHANNELS=3&PIXEL=1,1,1&TYPE=float\"\nresolution = 8\n");
#include <vmlight/stage/source_cache.h>
    const auto input = ImageInput::open(folder / "white.cfem");
#include <vmlight/stage/source_cache.h>
    ASSERT_TRUE(input) << OIIO::geterror();
#include <vmlight/stage/source_cache.h>
    for (float value : all_pixels(*input))
#include <vmlight/stage/source_cache.h>
        EXPECT_NEAR(value, 1, 1e-6);
#include <vmlight/stage/source_cache.h>
}
#include <vmlight/stage/source_cache.h>
