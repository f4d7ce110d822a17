// SPDX-License-Identifier: Apache-2.0
/// What readers keep between opens and when they let go of it; files that are damaged, or that hold a host up.
#include "stage_scene.h"

#include <vmlight/stage/source_cache.h>

#include <OpenImageIO/parallel.h>

#include <array>
#include <cstring>
#include <map>

#include <sys/stat.h>

using namespace vmlight;
using namespace stage_scene;
using OIIO::ImageBuf;
using OIIO::ImageInput;

namespace {

bool read_tile(const std::string& name, int x, int y, std::vector<float>& tile, std::string& error)
{
    const auto input = ImageInput::open(name);
    if (!input) {
        error = OIIO::geterror();
        return false;
    }
    tile.assign(size_t(64) * 64 * input->spec().nchannels, -1.0f);
    const bool good = input->read_tile(x, y, 0, OIIO::TypeFloat, tile.data());
    error = good ? "" : input->geterror();
    return good;
}

// A square facing +z, or +y, over the whole texture, in two files.
void write_gltf(const Folder& folder, bool up)
{
    const float positions[12]
        = { 0, 0, 0, 1, 0, 0, 1, up ? 0.f : 1.f, up ? -1.f : 0.f, 0, up ? 0.f : 1.f, up ? -1.f : 0.f };
    const float normal[3] = { 0, up ? 1.f : 0.f, up ? 0.f : 1.f }, uvs[8] = { 0, 1, 1, 1, 1, 0, 0, 0 };
    const uint16_t indices[6] = { 0, 1, 2, 0, 2, 3 };
    std::string bytes(reinterpret_cast<const char*>(positions), 48);
    for (int i = 0; i < 4; ++i)
        bytes.append(reinterpret_cast<const char*>(normal), 12);
    bytes.append(reinterpret_cast<const char*>(uvs), 32);
    bytes.append(reinterpret_cast<const char*>(indices), 12);
    folder.write("square.bin", bytes);
    if (std::filesystem::exists(folder / "square.gltf"))
        return;
    folder.write("square.gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3}]}],
"buffers":[{"uri":"square.bin","byteLength":140}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":48},
{"buffer":0,"byteOffset":96,"byteLength":32},{"buffer":0,"byteOffset":128,"byteLength":12}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,-1],"max":[1,1,0]},
{"bufferView":1,"componentType":5126,"count":4,"type":"VEC3"},{"bufferView":2,"componentType":5126,"count":4,"type":"VEC2"},
{"bufferView":3,"componentType":5123,"count":6,"type":"SCALAR"}]})");
}

} // namespace

// A thread that waits for OIIO's pool runs what is queued there meanwhile: here, tiles of the very image that it is
// about to prepare.
TEST(StageState, AThreadOfTheHostNeverWaitsForItself)
{
    const Folder folder;
    ASSERT_TRUE(folder.vismap().write(folder / "vm.exr"));
    ImageBuf albedo(OIIO::ImageSpec(37, 53, 3, OIIO::TypeFloat));
    OIIO::ImageBufAlgo::noise(albedo, "uniform", 0.1f, 0.9f, false, 1);
    ASSERT_TRUE(albedo.write(folder / "albedo.exr"));
    folder.write("large.cfem", "environment = \"studio.exr\"\nresolution = 512\n");
    folder.write("a.lightmap", "vismap = \"vm.exr\"\ncfem = \"studio.cfem\"\nalbedo = \"albedo.exr\"\n");
    folder.write("b.lightmap", "vismap = \"vm.exr\"\ncfem = \"large.cfem\"\n");
    for (int angle = 0; angle < 30; ++angle)
        for (const char* name : { "a", "b" }) {
            if (name[0] == 'b' && angle % 3 != 0)
                continue; // filtering is slow under sanitizers
            set_source_limits(1, 1); // so that each image prepares all it needs
            const auto input
                = ImageInput::open(folder / (std::string(name) + ".lightmap?rotate=0," + std::to_string(angle) + ",0"));
            ASSERT_TRUE(input) << OIIO::geterror();
            all_pixels(*input);
        }
    set_source_limits(size_t(1) << 30, 64);
}

TEST(StageState, ADamagedMapIsAnErrorOnEveryReadOfEveryOpen)
{
    const Folder folder;
    for (const bool tiled : { true, false }) {
        ImageBuf vismap = folder.vismap();
        vismap.specmod().attribute("compression", "none");
        vismap.specmod().attribute("openexr:lineOrder", "increasingY");
        if (tiled)
            vismap.set_write_tiles(64, 64);
        else
            vismap.set_write_tiles(0, 0);
        ASSERT_TRUE(vismap.write(folder / "vm.exr")) << vismap.geterror();
        const std::string whole = folder.bytes("vm.exr");
        folder.write("vm.exr", whole.substr(0, whole.size() - 60000));
        folder.write("cut.lightmap", "vismap = \"vm.exr\"\ncfem = \"studio.cfem\"\n");
        std::vector<float> tile;
        std::string error;
        EXPECT_TRUE(read_tile(folder / "cut.lightmap", 0, 0, tile, error)) << error;
        for (int i = 0; i < 3; ++i)
            for (int x : { 0, 64, 128, 192 }) {
                if (tiled && x < 192)
                    continue; // those of the last row that are there may be read
                EXPECT_FALSE(read_tile(folder / "cut.lightmap", x, 128, tile, error)) << tiled << " " << i << " " << x;
                EXPECT_NE(error.find("vm.exr\": "), std::string::npos) << error;
            }
    }
}

TEST(StageState, AChangedBufferOfAMeshIsReadAnew)
{
    const Folder folder;
    write_gltf(folder, false);
    folder.write("square.vismap", "mesh = \"square.gltf\"\nresolution = 64\nsamples = 16\n");
    folder.write("square.lightmap", "vismap = \"square.vismap\"\ncfem = \"studio.cfem\"\n");
    std::vector<float> tile, lit, lit_again;
    std::string error;
    ASSERT_TRUE(read_tile(folder / "square.vismap", 0, 0, tile, error)) << error;
    ASSERT_TRUE(read_tile(folder / "square.lightmap", 0, 0, lit, error)) << error;
    EXPECT_NEAR(tile[3], 2.0 / 3, 1e-6);
    write_gltf(folder, true);
    ASSERT_TRUE(read_tile(folder / "square.vismap", 0, 0, tile, error)) << error;
    ASSERT_TRUE(read_tile(folder / "square.lightmap", 0, 0, lit_again, error)) << error;
    EXPECT_NEAR(tile[2], 2.0 / 3, 1e-6);
    EXPECT_NE(lit, lit_again);
}

TEST(StageState, ContentPutInPlaceWithSizeAndTimeKeptIsReadAnew)
{
    const Folder folder;
    folder.write("sky.pfm", std::string("PF\n1 1\n-1.0\n") + std::string("\0\0\x80\x3f\0\0\x80\x3f\0\0\x80\x3f", 12));
    folder.write("sky.cfem", "environment = \"sky.pfm\"\nresolution = 4\n");
    const auto time = std::filesystem::last_write_time(folder / "sky.pfm");
    EXPECT_FLOAT_EQ(all_pixels(*ImageInput::open(folder / "sky.cfem"))[0], 1);
    folder.write("sky.pfm", std::string("PF\n1 1\n-1.0\n") + std::string("\0\0\0\x40\0\0\0\x40\0\0\0\x40", 12));
    std::filesystem::last_write_time(folder / "sky.pfm", time);
    EXPECT_FLOAT_EQ(all_pixels(*ImageInput::open(folder / "sky.cfem"))[0], 2);
}

TEST(StageState, APipeIsNoInput)
{
    const Folder folder;
    ASSERT_EQ(::mkfifo((folder / "pipe.exr").c_str(), 0600), 0);
    folder.write("pipe.cfem", "environment = \"pipe.exr\"\n");
    EXPECT_FALSE(ImageInput::open(folder / "pipe.cfem"));
    EXPECT_NE(OIIO::geterror().find("pipe.exr\": not a file"), std::string::npos);
}

TEST(StageState, WhatIsOpenIsFoundAgainHoweverLittleIsKept)
{
    const Folder folder;
    const auto input = ImageInput::open(folder / "hero.lightmap");
    const auto first = all_pixels(*input);
    set_source_limits(1, 1);
    folder.write("other.cfem", "environment = \"studio.exr\"\nresolution = 8\n");
    EXPECT_TRUE(ImageInput::open(folder / "other.cfem")); // the one source that is kept
    const Work before;
    EXPECT_EQ(all_pixels(*ImageInput::open(folder / "hero.lightmap")), first);
    EXPECT_EQ((Work() - before).meshes_read, 0);
    EXPECT_EQ((Work() - before).cfems_made, 0);
    set_source_limits(size_t(1) << 30, 64);
}

TEST(StageState, RotationsShareTheConvertedAlbedo)
{
    const Folder folder;
    ImageBuf albedo(OIIO::ImageSpec(20, 30, 3, OIIO::TypeUInt8));
    OIIO::ImageBufAlgo::noise(albedo, "uniform", 0.1f, 0.9f, false, 1);
    ASSERT_TRUE(albedo.write(folder / "paint.png"));
    folder.write("painted.lightmap", "vismap = \"hero.vismap\"\ncfem = \"studio.cfem\"\nalbedo = \"paint.png\"\n");
    const int64_t before = work_counts().albedos_made;
    const auto one = all_pixels(*ImageInput::open(folder / "painted.lightmap?rotate=0,10,0"));
    EXPECT_NE(all_pixels(*ImageInput::open(folder / "painted.lightmap?rotate=0,100,0")), one);
    EXPECT_EQ(work_counts().albedos_made - before, 1);
}

TEST(StageState, AConfigMattersOnlyWhereColourIsConverted)
{
    const Folder folder;
    ASSERT_TRUE(folder.vismap().write(folder / "vm.exr"));
    ImageBuf cfem = folder.cfem();
    ASSERT_TRUE(cfem.write(folder / "labelled.exr"));
    for (const char* label : { "colorInteropID", "chromaticities" })
        cfem.specmod().erase_attribute(label);
    ASSERT_TRUE(cfem.write(folder / "cfem.exr"));
    folder.write("stored.lightmap", "vismap = \"vm.exr\"\ncfem = \"cfem.exr\"\ncolorconfig = \"gone.ocio\"\n");
    folder.write("live.lightmap", "vismap = \"vm.exr\"\nenvironment = \"studio.exr\"\ncolorconfig = \"gone.ocio\"\n");
    EXPECT_TRUE(ImageInput::open(folder / "stored.lightmap")) << OIIO::geterror();
    for (const std::string& name :
         { folder / "live.lightmap", folder / "stored.lightmap?cfem=" + (folder / "labelled.exr") }) {
        EXPECT_FALSE(ImageInput::open(name));
        EXPECT_NE(OIIO::geterror().find("gone.ocio\": no such file"), std::string::npos) << name;
    }
}

TEST(StageState, AnInputMayBeAnImageThatAnotherReaderMakesFromItsName)
{
    const Folder folder;
    folder.write("white.cfem",
                 "environment = \"/x.null?RES=64x32&CHANNELS=3&PIXEL=1,1,1&TYPE=float\"\nresolution = 8\n");
    const auto input = ImageInput::open(folder / "white.cfem");
    ASSERT_TRUE(input) << OIIO::geterror();
    for (float value : all_pixels(*input))
        EXPECT_NEAR(value, 1, 1e-6);
}
