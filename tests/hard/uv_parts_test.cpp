// SPDX-License-Identifier: Apache-2.0
// Parts of a file that share a texture, and what of a file is baked.
#include "hard_case.h"
#include "judgement.h"
#include "room.h"
#include "temporary_folder.h"

#include <vmlight/base/format.h>
#include <vmlight/stage/make_stage.h>

#include <OpenImageIO/strutil.h>

#include <gmock/gmock.h>

using namespace vmlight;
using OIIO::ImageBuf;

namespace {

VismapRecipe recipe_of(const std::string& path, const MeshSelection& selection = {})
{
    VismapRecipe recipe;
    recipe.mesh = path;
    recipe.selection = selection;
    recipe.mesh_params.normals = "flat";
    recipe.vismap_params.resolution = { 64, 64 };
    recipe.vismap_params.samples = 64;
    recipe.vismap_params.reconstruct = "off"; // a part's texels have the neighbours of the part
    recipe.vismap_params.margin = 0;
    return recipe;
}

ImageBuf made(const VismapRecipe& recipe, std::string* warning = nullptr)
{
    MakeOptions options;
    options.warn = [&](const std::string& line) {
        if (warning)
            *warning += line + "\n";
    };
    ImageBuf image;
    EXPECT_TRUE(make_image(image, recipe, options)) << image.geterror();
    return image;
}

// The room, turned and stretched: no coordinate is a short fraction.
std::string odd_room()
{
    std::string text;
    for (const std::string& line : OIIO::Strutil::splits(room_obj(), "\n")) {
        const std::vector<std::string> words = OIIO::Strutil::splits(line, " ");
        if (!OIIO::Strutil::starts_with(line, "v ")) {
            text += line + "\n";
            continue;
        }
        const double x = OIIO::Strutil::stod(words[1]), y = OIIO::Strutil::stod(words[2]),
                     z = OIIO::Strutil::stod(words[3]);
        text += format("v {:.9g} {:.9g} {:.9g}\n", .61 * x - .33 * y + .17 * z + .3, .29 * x + .7 * y - .21 * z,
                       -.11 * x + .13 * y + .77 * z);
    }
    return text;
}

// Texels of `part`; the greatest difference from `whole` there.
std::pair<int, float> compare(const ImageBuf& part, const ImageBuf& whole)
{
    int texels = 0;
    float most = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            if (part.getchannel(x, y, 0, 0) == 0)
                continue;
            ++texels;
            for (int channel = 0; channel < 4; ++channel)
                most = std::max(most, std::abs(part.getchannel(x, y, 0, channel) - whole.getchannel(x, y, 0, channel)));
        }
    return { texels, most };
}

} // namespace

TEST(Uv, APartOfAFile)
{
    HardCase row("One material, or one node, of a file is baked, at coordinates that floats round");
    const TemporaryFolder folder;
    const std::string path = folder.write("room.obj", odd_room());
    const ImageBuf whole = made(recipe_of(path));
    for (const auto& [selection, quads] : { std::pair(MeshSelection { { "Brick" }, {} }, 1),
                                            { MeshSelection { { "Stone" }, {} }, 2 },
                                            { MeshSelection { {}, { "House" } }, 2 },
                                            { MeshSelection { { "Stone" }, { "House" } }, 1 } }) {
        const auto [texels, difference] = compare(made(recipe_of(path, selection)), whole);
        EXPECT_EQ(texels, quads * 1024);
        EXPECT_EQ(difference, 0);
    }
    const std::string floor = folder.write("floor.obj", odd_room().substr(0, odd_room().find("o House")));
    const auto [texels, difference] = compare(made(recipe_of(floor)), whole);
    EXPECT_EQ(texels, 1024);
    EXPECT_GT(difference, .3f);
    row.naive(format("without the rest of the file V is off by up to {:.1f}", difference));
    row.ours("the rest occludes: bit for bit the texels of the whole file's map");
}

TEST(Uv, APartOfAVeryLargeFile)
{
    HardCase row(
        "A square under a lid 1/1000 of its size above it, beside a ground 8000 times as large in the same file");
    const TemporaryFolder folder;
    const auto square = [](double x, double half, double z, int first, bool has_uvs) {
        std::string text;
        for (const auto& [dx, dy] : { std::pair(-1, -1), { 1, -1 }, { 1, 1 }, { -1, 1 } })
            text += format("v {} {} {}\n", x + dx * half, dy * half, z);
        text += "f";
        for (int corner = 0; corner < 4; ++corner)
            text += format(" {}", first + corner) + (has_uvs ? format("/{}", corner + 1) : "");
        return text + "\n";
    };
    const std::string path
        = folder.write("city.obj",
                       "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\no Square\n" + square(0, 1, 0, 1, true) + "o Lid\n"
                           + square(0, 8, .002, 5, false) + "o Ground\n" + square(9000, 8000, -1, 9, false));
    const auto centre = [](const ImageBuf& image) { return image.getchannel(32, 32, 0, 0); };
    const float whole = centre(made(recipe_of(path))), part = centre(made(recipe_of(path, { {}, { "Square" } })));
    EXPECT_EQ(whole, 1);
    EXPECT_EQ(part, 0);
    row.naive(format("rays start above the lid: V = {}", whole));
    row.ours("the part has a scene of its own precision: V = 0");
}

TEST(Uv, APartThatIsNotThere)
{
    HardCase row("A material or node by a name that the file does not have, or that no triangle has");
    const TemporaryFolder folder;
    const std::string path = folder.write("room.obj", room_obj());
    EXPECT_THAT(refusal(recipe_of(path, { { "stone" }, {} })), testing::HasSubstr("; did you mean \"Stone\"?"));
    EXPECT_THAT(refusal(recipe_of(path, { {}, { "Ground", "Huose" } })),
                testing::HasSubstr("; did you mean \"House\"?"));
    EXPECT_THAT(refusal(recipe_of(path, { { "W*" }, {} })), testing::HasSubstr("no material \"W*\"; the file has "));
    EXPECT_THAT(refusal(recipe_of(path, { { "Brick" }, { "Ground" } })), testing::HasSubstr("no triangle has the "));
    row.naive("an empty map, or one of the whole file");
    row.ours("refused, with the nearest names");
}

TEST(Uv, MaterialsOnTheSameTexture)
{
    HardCase row("Three materials, each with the whole texture to itself");
    const TemporaryFolder folder;
    const std::string obj = OIIO::Strutil::replace(room_obj(true), "usemtl Stone\nf 7", "usemtl Glass\nf 7");
    const std::string path = folder.write("room.obj", obj);
    std::string warning;
    const ImageBuf floor = made(recipe_of(path), &warning);
    EXPECT_THAT(warning, testing::HasSubstr("materials Stone, Brick, Glass overlap 0 % each: try <MATERIAL> in -o"));
    EXPECT_EQ(compare(made(recipe_of(path, { { "Stone" }, {} })), floor), std::pair(1024, 0.f));
    warning.clear();
    for (const char* other : { "Brick", "Glass" }) {
        const auto [texels, difference] = compare(made(recipe_of(path, { { other }, {} }), &warning), floor);
        EXPECT_EQ(texels, 1024);
        EXPECT_GT(difference, .1f);
    }
    EXPECT_EQ(warning, "");
    row.naive("the first one, or the last, wins all texels");
    row.ours("the warning names them; `<MATERIAL>` in `-o` makes a map of each");
}
