// SPDX-License-Identifier: Apache-2.0
// Damaged files: each ends in an image of finite pixels, or in one line that says why not.
#include "damage.h"
#include "hard_case.h"
#include "temporary_folder.h"

#include <vmlight/image/image_file.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/stage/pixel_source.h>

#include <OpenImageIO/imagebufalgo.h>

#include <cmath>

using namespace vmlight;
using OIIO::Strutil::fmt::format;

namespace {

std::string fault_of_reason(const std::string& reason)
{
    if (reason.empty())
        return "failed without a reason";
    return reason.find('\n') == std::string::npos ? "" : "more than one line: " + reason;
}

std::string fault_of_pixels(const float* pixels, size_t count)
{
    for (size_t i = 0; i < count; ++i)
        if (!std::isfinite(pixels[i]))
            return format("value {} is {}", i, pixels[i]);
    return "";
}

template <class Recipe> std::string try_to_make(const Recipe& recipe)
{
    OIIO::ImageBuf image;
    try {
        if (!make_image(image, recipe))
            return fault_of_reason(image.geterror());
    } catch (const std::exception&) {
        return ""; // which mains and readers catch
    }
    return fault_of_pixels(static_cast<const float*>(image.localpixels()),
                           size_t(image.spec().image_pixels()) * size_t(image.nchannels()));
}

// As a reader does.
std::string try_to_read(const std::string& path)
{
    std::string error;
    try {
        const PixelSourcePointer source = open_source(path, error);
        if (!source)
            return fault_of_reason(error);
        OIIO::ROI roi = OIIO::get_roi(source->spec());
        roi.xend = std::min(roi.xend, roi.xbegin + 64);
        roi.yend = std::min(roi.yend, roi.ybegin + 64);
        std::vector<float> pixels(roi.npixels() * size_t(source->spec().nchannels));
        return source->read(roi, pixels.data(), error) ? fault_of_pixels(pixels.data(), pixels.size())
                                                       : fault_of_reason(error);
    } catch (const std::exception&) {
        return "";
    }
}

const char* const kQuad = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n"
                          "f 1/1/1 2/2/1 3/3/1 4/4/1\n";

template <class Number> std::string bytes_of(std::initializer_list<Number> numbers)
{
    return std::string(reinterpret_cast<const char*>(numbers.begin()), numbers.size() * sizeof(Number));
}

std::string quad_ply()
{
    const std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\n"
                               "property float y\nproperty float z\nproperty float s\nproperty float t\n"
                               "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
    return header + bytes_of<float>({ -1, -1, 0, 0, 0, 1, -1, 0, 1, 0, 1, 1, 0, 1, 1, -1, 1, 0, 0, 1 }) + "\3"
        + bytes_of<int32_t>({ 0, 1, 2 }) + "\3" + bytes_of<int32_t>({ 0, 2, 3 });
}

std::string quad_glb()
{
    std::string json
        = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[)"
          R"({"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2}]}],"buffers":[{"byteLength":92}],"bufferViews":[)"
          R"({"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":32},)"
          R"({"buffer":0,"byteOffset":80,"byteLength":12}],"accessors":[)"
          R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)"
          R"({"bufferView":1,"componentType":5126,"count":4,"type":"VEC2"},)"
          R"({"bufferView":2,"componentType":5123,"count":6,"type":"SCALAR"}]})";
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::string buffer = bytes_of<float>({ -1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0, 0, 0, 1, 0, 1, 1, 0, 1 })
        + bytes_of<uint16_t>({ 0, 1, 2, 0, 2, 3 });
    const std::string chunks = bytes_of<uint32_t>({ uint32_t(json.size()) }) + "JSON" + json
        + bytes_of<uint32_t>({ uint32_t(buffer.size()) }) + std::string("BIN\0", 4) + buffer;
    return "glTF" + bytes_of<uint32_t>({ 2, uint32_t(12 + chunks.size()) }) + chunks;
}

// In a process of its own too: one that comes of a fork has none of the threads that OIIO started before.
void write_sky(const std::string& path)
{
    survive({ { "no damage", "" } }, [&](const Damage&) {
        OIIO::ImageBuf sky(OIIO::ImageSpec(16, 8, 3, OIIO::TypeFloat));
        OIIO::ImageBufAlgo::checker(sky, 4, 4, 1, { 0.1f, 0.2f, 0.3f }, { 2.0f, 3.0f, 1.0f });
        return sky.write(path) ? "" : sky.geterror();
    });
}

VismapRecipe small_bake(const std::string& mesh)
{
    VismapRecipe recipe;
    recipe.mesh = mesh;
    recipe.vismap_params.resolution = { 16, 16 };
    recipe.vismap_params.samples = 4;
    return recipe;
}

} // namespace

TEST(Files, DamagedMeshesOneByOne)
{
    HardCase row("OBJ, binary PLY and GLB, each cut at 40 places, and with a bit turned over at 100");
    const std::pair<const char*, std::string> files[]
        = { { "quad.obj", kQuad }, { "quad.ply", quad_ply() }, { "quad.glb", quad_glb() } };
    for (const auto& file : files) {
        const TemporaryFolder folder;
        const std::string path = folder.write(file.first, file.second);
        survive({ { "no damage", "" } }, [&](const Damage&) {
            OIIO::ImageBuf whole;
            return make_image(whole, small_bake(path)) ? "" : whole.geterror();
        });
        survive(damages_of(file.second),
                [&](const Damage& damage) { return try_to_make(small_bake(folder.write(file.first, damage.bytes))); });
    }
    row.naive("assimp 5.2 reads beyond its memory, or ends the process, at one in four PLYs");
    row.ours("420 times finite pixels or one line");
}

TEST(Files, DamagedImagesOneByOne)
{
    HardCase row("EXR and HDR, each cut at 40 places, and with a bit turned over at 100");
    for (const char* name : { "sky.exr", "sky.hdr" }) {
        const TemporaryFolder folder;
        write_sky(folder / name);
        CfemRecipe recipe;
        recipe.environment = folder / name;
        recipe.cfem_params.resolution = { 8, 4 };
        survive(damages_of(folder.bytes(name)), [&](const Damage& damage) {
            folder.write(name, damage.bytes);
            const std::string fault = try_to_make(recipe);
            return fault.empty() ? try_to_read(folder / name) : fault;
        });
    }
    row.naive("a flipped bit of a header asks for gigabytes, or keeps a filter busy for a minute");
    row.ours("280 times finite pixels or one line, in makers and readers");
}

TEST(Files, DamagedRecipesOneByOne)
{
    HardCase row("Recipes of three stages, each cut at 40 places, and with a bit turned over at 100");
    const TemporaryFolder folder;
    folder.write("quad.obj", kQuad);
    write_sky(folder / "sky.exr");
    folder.write("a.vismap", "mesh = \"quad.obj\"\nsamples = 4\nresolution = [16, 16]\nmargin = 2\n");
    folder.write("a.cfem", "environment = \"sky.exr\"\nresolution = 8\n");
    folder.write("a.lightmap", "vismap = \"a.vismap\"\ncfem = \"a.cfem\"\nrotate = [0, 30, 0]\n");
    for (const char* name : { "a.vismap", "a.cfem", "a.lightmap" }) {
        const std::string whole = folder.bytes(name);
        survive(damages_of(whole), [&](const Damage& damage) { return try_to_read(folder.write(name, damage.bytes)); });
        folder.write(name, whole);
    }
    row.naive("a key that has become another is passed over: exit code 0 with a wrong picture");
    row.ours("420 times finite pixels or one line, in the readers");
}
