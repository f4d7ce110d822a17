// SPDX-License-Identifier: Apache-2.0
// Damaged files: each ends in an image of finite pixels, or in one line that says why not, and in little memory.
#include "cases.h"
#include "files.h"
#include "hard_case.h"
#include "quad_files.h"
#include "watchdog.h"

#include <vmlight/base/format.h>
#include <vmlight/image/image_file.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/stage/open_source.h>

#include <OpenImageIO/imagebufalgo.h>

#include <cctype>
#include <cmath>
#include <tuple>

using namespace vmlight;

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
// @param whole     the file's blocks are as long as its header says: OpenEXR 3.1 leaves memory as it was where a
//                  compressed block is shorter, so that any value may come of it
std::string try_to_read(const std::string& path, bool whole = true)
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
        if (!source->read(roi, pixels.data(), error))
            return fault_of_reason(error);
        return whole ? fault_of_pixels(pixels.data(), pixels.size()) : "";
    } catch (const std::exception&) {
        return "";
    }
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

TEST_F(Files, DamagedMeshesOneByOne)
{
    HardCase row("OBJ, binary PLY and GLB, each truncated at 40 places and with one bit flipped at 100");
    const std::pair<std::string, std::string> files[]
        = { { "m.obj", kQuad }, { "m.ply", quad_ply() }, { "m.glb", quad_glb() } };
    for (const auto& file : files) {
        OIIO::ImageBuf image;
        ASSERT_TRUE(make_image(image, small_bake(write(file.first, file.second)))) << image.geterror();
        survive(damages_of(file.second),
                [&](const Damage& damage) { return try_to_make(small_bake(write(file.first, damage.bytes))); });
    }
    row.naive("a reader that trusts lengths and indices reads out of bounds");
    row.ours("420 times finite pixels or a one-line error");
}

TEST_F(Files, DamagedImagesOneByOne)
{
    HardCase row("EXR and HDR, each truncated at 40 places and with one bit flipped at 100");
    for (const std::string name : { "sky.exr", "sky.hdr" }) {
        CfemRecipe recipe;
        recipe.environment = name;
        recipe.cfem_params.resolution = { 8, 4 };
        survive(damages_of(read(name)), [&](const Damage& damage) {
            write(name, damage.bytes);
            const std::string fault = try_to_make(recipe);
            return fault.empty() ? try_to_read(name) : fault;
        });
    }
    row.naive("a flipped bit in a header asks for gigabytes, or keeps a filter busy for a minute");
    row.ours("280 times finite pixels or a one-line error, in executables and readers");
}

TEST_F(Files, HeadersThatClaimTooMuch)
{
    HardCase row("EXR and HDR with one high bit of any byte of the header flipped: tiles, scanlines, several parts");
    const size_t step = cases(1, 5);
    done("makecfem sky.exr -o stack.exr --stack --resolution 8 --quiet");
    for (const std::string name : { "sky.exr", "vm.exr", "stack.exr", "sky.hdr" }) {
        const std::string whole = read(name);
        // Headers end where the pixels begin; that they are small is what makes the claims large.
        std::vector<Damage> damages;
        for (size_t byte = 0; byte < std::min(whole.size(), size_t(name == "stack.exr" ? 2000 : 1200)); byte += step)
            for (const int bit : { 5, 7 }) {
                if (bit == 7 && name == "stack.exr")
                    continue;
                std::string flipped = whole;
                flipped[byte] = char(flipped[byte] ^ (1 << bit));
                damages.push_back({ format("bit {} of byte {} of {}", bit, byte, name), flipped });
            }
        survive(damages, [&](const Damage& damage) { return try_to_read(write(name, damage.bytes), false); });
        write(name, whole);
    }
    row.naive("a file of 677 bytes may claim a string of 512 MiB, for which a library makes room (measured)");
    row.ours("less than 50 MB each: a size beyond the file is refused before OpenEXR reads it");
}

TEST_F(Files, NumbersBeyondTheFile)
{
    HardCase row("Each number in the header of an OBJ, PLY, glTF, HDR or recipe is a thousand million");
    const auto damages_of_numbers = [](const std::string& whole, size_t end) {
        std::vector<Damage> damages;
        for (size_t at = 0; at < end; ++at) {
            const bool begins = std::isdigit(whole[at]) && (at == 0 || !std::isdigit(whole[at - 1]));
            const size_t rest = std::min(whole.find_first_not_of("0123456789", at), whole.size());
            if (begins)
                damages.push_back(
                    { format("number at {}", at), whole.substr(0, at) + "999999999" + whole.substr(rest) });
        }
        return damages;
    };
    const std::string json = quad_gltf("m.bin");
    write("m.bin", quad_buffer());
    for (const auto& [name, whole, end] : { std::tuple<std::string, std::string, size_t>("m.obj", kQuad, kQuad.size()),
                                            { "m.ply", quad_ply(), quad_ply_header("binary_little_endian").size() },
                                            { "text.ply", quad_ply_text(), quad_ply_text().size() },
                                            { "m.gltf", json, json.size() },
                                            { "m.glb", quad_glb(), 20 + quad_gltf().size() } })
        survive(damages_of_numbers(whole, end),
                [&, name = name](const Damage& damage) { return try_to_make(small_bake(write(name, damage.bytes))); });
    CfemRecipe recipe;
    recipe.environment = "sky.hdr";
    recipe.cfem_params.resolution = { 8, 4 };
    const std::string sky = read("sky.hdr");
    survive(damages_of_numbers(sky, sky.find("+X") + 8), [&](const Damage& damage) {
        write("sky.hdr", damage.bytes);
        return try_to_make(recipe);
    });
    write("sky.hdr", sky);
    const std::string bake = "mesh = \"quad.obj\"\nsamples = 4\nresolution = [16, 16]\nmargin = 2\nudim = 1001\n";
    survive(damages_of_numbers(bake, bake.size()),
            [&](const Damage& damage) { return try_to_read(write("n.vismap", damage.bytes)); });
    row.naive("room for a thousand million of what is not there");
    row.ours("less than 50 MB each");
}

TEST_F(Files, DamagedRecipesOneByOne)
{
    HardCase row("Recipes of three stages, each truncated at 40 places and with one bit flipped at 100");
    write("a.vismap", "mesh = \"quad.obj\"\nsamples = 4\nresolution = [16, 16]\nmargin = 2\n");
    write("a.cfem", "environment = \"sky.exr\"\nresolution = 8\n");
    write("a.lightmap", "vismap = \"a.vismap\"\ncfem = \"a.cfem\"\nrotate = [0, 30, 0]\n");
    for (const std::string name : { "a.vismap", "a.cfem", "a.lightmap" }) {
        const std::string whole = read(name);
        survive(damages_of(whole), [&](const Damage& damage) { return try_to_read(write(name, damage.bytes)); });
        write(name, whole);
    }
    row.naive("a misspelt key is ignored: exit code 0 with a wrong image");
    row.ours("420 times finite pixels or a one-line error, in the readers");
}
