// SPDX-License-Identifier: Apache-2.0
// Damaged files, by the executables' own mains and by the plugins: each ends in a picture of finite pixels, or in one
// line. A few of the damages each; files_test.cpp tries many.
#include "files.h"
#include "hard_case.h"
#include "quad_files.h"

#include <cstring>

using namespace vmlight;
using testing::HasSubstr;

namespace {

// Every seventh: some of the cuts, and some of the bits.
std::vector<Damage> some_damages_of(const std::string& whole)
{
    const std::vector<Damage> all = damages_of(whole);
    std::vector<Damage> some;
    for (size_t at = 0; at < all.size(); at += 7)
        some.push_back(all[at]);
    return some;
}

} // namespace

void Files::expect_survival(const std::string& name, const std::string& whole, const std::string& line,
                            const std::string& recipe) const
{
    survive(some_damages_of(whole), [&](const Damage& damage) {
        write(name, damage.bytes);
        const Result result = run(line + " -o x.exr --quiet");
        if (result.code == 0) {
            expect_finite("x.exr");
            remove("x.exr");
        } else {
            expect_one_error(result, 1);
            EXPECT_FALSE(exists("x.exr")) << line;
        }
        if (!recipe.empty())
            read_by_plugin(recipe);
        return HasFailure() ? name : "";
    });
    write(name, whole);
}

TEST_F(Files, DamagedMeshes)
{
    HardCase row("OBJ, PLY, glTF and GLB, truncated or with one bit flipped");
    write("m.vismap", "mesh = \"m.glb\"\nresolution = 16\nsamples = 4\n");
    const std::pair<std::string, std::string> files[]
        = { { "m.obj", kQuad },      { "text.ply", quad_ply_text() },  { "binary.ply", quad_ply() },
            { "m.glb", quad_glb() }, { "m.gltf", quad_gltf("m.bin") }, { "m.bin", quad_buffer() } };
    write("m.bin", quad_buffer());
    for (const auto& [name, whole] : files) {
        write(name, whole);
        const std::string bake = "makevismap " + (name == "m.bin" ? "m.gltf" : name) + " --resolution 16 --samples 4";
        done(bake + " -o x.exr --quiet"); // undamaged
        remove("x.exr");
        expect_survival(name, whole, bake, name == "m.glb" ? "m.vismap" : "");
    }
    row.naive("a reader that trusts lengths and indices reads out of bounds");
    row.ours("finite pixels, or exit code 1 and one line");
}

TEST_F(Files, DamagedImages)
{
    HardCase row("EXR and HDR, truncated or with one bit flipped");
    write("d.lightmap", "vismap = \"vm.exr\"\ncfem = \"cfem.exr\"\n");
    write("d.cfem", "environment = \"sky.hdr\"\nresolution = 8\n");
    const std::string light = "makelightmap vm.exr cfem.exr";
    expect_survival("vm.exr", read("vm.exr"), light, "d.lightmap");
    expect_survival("cfem.exr", read("cfem.exr"), light, "");
    expect_survival("sky.exr", read("sky.exr"), "makecfem sky.exr --resolution 8", "");
    expect_survival("sky.hdr", read("sky.hdr"), "makecfem sky.hdr --resolution 8", "d.cfem");
    row.naive("unreadable rows become black");
    row.ours("finite pixels, or exit code 1 and one line");
}

TEST_F(Files, DamagedRecipes)
{
    HardCase row("Recipes, truncated or with one bit flipped");
    write("d.vismap", "mesh = \"quad.obj\"\nresolution = [16, 16]\nsamples = 4\nmargin = 2\nnormals = \"flat\"\n");
    write("d.cfem", "environment = \"sky.exr\"\nresolution = 8\n");
    write("d.lightmap",
          "vismap = \"d.vismap?resolution=16&samples=1\"\ncfem = \"d.cfem?resolution=8\"\n"
          "rotate = [0, 30, 0]\n");
    expect_survival("d.vismap", read("d.vismap"), "makevismap d.vismap --resolution 16", "d.vismap");
    expect_survival("d.cfem", read("d.cfem"), "makecfem d.cfem --resolution 8", "d.cfem");
    expect_survival("d.lightmap", read("d.lightmap"), "makelightmap d.lightmap", "d.lightmap");
    row.naive("a misspelt key is ignored");
    row.ours("the image of the remaining recipe, or exit code 1 and one line");
}

TEST_F(Files, DisplayWindowWithOneBitTooMany)
{
    HardCase row("One wrong bit in an EXR's display window: 2^28 columns of black around 16 of light");
    std::string bytes = read("sky.exr");
    const size_t at = bytes.find(std::string("displayWindow\0box2i\0", 20)) + 20 + 4;
    int32_t window[4];
    std::memcpy(window, bytes.data() + at, sizeof(window));
    EXPECT_THAT(window, testing::ElementsAre(0, 0, 15, 7));
    window[2] |= 1 << 28;
    std::memcpy(bytes.data() + at, window, sizeof(window));
    write("wide.exr", bytes);
    const std::string fault = "its header says 268435472x8 pixels";
    expect_one_error(run("makecfem wide.exr -o x.exr --resolution 8"), 1,
                     "\"wide.exr\": " + fault + "; the maximum is 1048576 per side");
    write("wide.cfem", "environment = \"wide.exr\"\nresolution = 8\n");
    EXPECT_THAT(read_by_plugin("wide.cfem"), HasSubstr(fault));
    row.naive("all are processed: 45 s, then out of memory");
    row.ours("exit code 1 at once, quoting the header");
}
