// SPDX-License-Identifier: Apache-2.0
// The materials of OBJ files.
#include "temporary_folder.h"

#include <vmlight/mesh/import/mtl.h>

#include <gtest/gtest.h>

using namespace vmlight;
using Imath::C4f;
using Imath::V2d;

namespace {

std::vector<Material> materials_of(const std::string& text, const std::string& folder = "folder")
{
    std::vector<Material> materials;
    add_mtl_materials(materials, text, folder);
    return materials;
}

// Of the statements behind `newmtl m`.
Material mtl_material(const std::string& statements, const std::string& folder = "folder")
{
    const std::vector<Material> materials = materials_of("newmtl m\n" + statements + "\n", folder);
    EXPECT_EQ(materials.size(), 1u);
    return materials.empty() ? Material() : materials[0];
}

V2d placed_uv(const MaterialTexture& texture, const V2d& uv)
{
    return uv * texture.uv_transform;
}

} // namespace

TEST(Mtl, HasMaterialsInOrder)
{
    const auto materials
        = materials_of("\xef\xbb\xbf# by hand\r\nKd 1 0 0\r\nnewmtl a b \r\n\tKd .1 .2 .3 # c\r\n"
                       "newmtl\tMaterial #25\r\nnewmtl c # not d\r\nd .5\r\nnewmtl a b\r\nKd 1 1 1\r\n");
    ASSERT_EQ(materials.size(), 3u);
    EXPECT_EQ(materials[0].name, "a b");
    EXPECT_EQ(materials[0].base_color, C4f(1, 1, 1, 1)) << "the last one of a name";
    EXPECT_EQ(materials[1].name, "Material #25");
    EXPECT_EQ(materials[2].name, "c");
    EXPECT_TRUE(materials_of("").empty());
    EXPECT_TRUE(materials_of("Kd 1 1 1\nnewmtl\n").empty());
}

TEST(Mtl, ColourAndOpacity)
{
    EXPECT_EQ(mtl_material("Kd .1 .2 .3").base_color, C4f(0.1f, 0.2f, 0.3f, 1));
    EXPECT_EQ(mtl_material("Kd .5").base_color, C4f(0.5f, 0.5f, 0.5f, 1)) << "one number is all three";
    EXPECT_EQ(mtl_material("Kd spectral a.rfl 1").base_color, C4f(1, 1, 1, 1));
    EXPECT_EQ(mtl_material("").base_color, C4f(1, 1, 1, 1));
    EXPECT_EQ(mtl_material("").alpha_mode, AlphaMode::opaque);
    EXPECT_EQ(mtl_material("d 1").alpha_mode, AlphaMode::opaque);
    for (const char* opacity : { "d .25", "d -halo .25", "Tr .75", "d .25\nTr 1", "Tr 1\nd .25", "D\t.25" }) {
        EXPECT_EQ(mtl_material(opacity).base_color.a, 0.25f) << opacity;
        EXPECT_EQ(mtl_material(opacity).alpha_mode, AlphaMode::blend) << opacity;
    }
    EXPECT_EQ(mtl_material("d 1\nTr 1").base_color.a, 1) << "writers that take Tr for opacity write both";
    EXPECT_EQ(mtl_material("d 7").base_color.a, 1);
    EXPECT_EQ(mtl_material("d nan").base_color.a, 1);
    EXPECT_FALSE(mtl_material("d .5").is_double_sided);
}

TEST(Mtl, TexturesAreBesideTheFile)
{
    const TemporaryFolder folder;
    folder.write("a b.png", "");
    const auto path_of = [&](const std::string& name) {
        const std::string path = mtl_material("map_Kd " + name, folder / "").base_color_texture.path;
        return path.substr(path.find(folder / "") == 0 ? (folder / "").size() : 0);
    };
    EXPECT_EQ(path_of("a b.png"), "a b.png");
    EXPECT_EQ(path_of("a b.png # the texture"), "a b.png");
    EXPECT_EQ(path_of("C:\\work\\maps\\a b.png"), "a b.png") << "where the file was written is elsewhere";
    EXPECT_EQ(path_of("/none/a b.png"), "a b.png");
    EXPECT_EQ(path_of("maps\\none.png"), "maps/none.png");
    EXPECT_EQ(path_of("/none/none.png"), "/none/none.png");
    EXPECT_EQ(mtl_material("map_Kd a.png", "").base_color_texture.path, "a.png");
    EXPECT_FALSE(mtl_material("map_Kd").base_color_texture.exists());
    EXPECT_FALSE(mtl_material("map_Kd -clamp on").base_color_texture.exists());
}

TEST(Mtl, TexturesHaveOptions)
{
    const MaterialTexture plain = mtl_material("map_Kd 7.png").base_color_texture;
    EXPECT_EQ(plain.path, "folder/7.png");
    EXPECT_EQ(plain.wrap_s, "periodic");
    EXPECT_EQ(placed_uv(plain, V2d(0.25, 0.5)), V2d(0.25, 0.5));
    const MaterialTexture all
        = mtl_material("map_kd -blendu off -blendv on -boost 1.5 -mm 0 1 -o .5 .25 0 -s 2 4 1 -t 0 0 0 -texres 512 "
                       "-clamp on -imfchan r -type sphere -cc on a  b.png")
              .base_color_texture;
    EXPECT_EQ(all.path, "folder/a  b.png");
    EXPECT_EQ(all.wrap_s, "clamp");
    EXPECT_EQ(all.wrap_t, "clamp");
    EXPECT_EQ(placed_uv(all, V2d(0.25, 0.5)), V2d(0.5 + 0.5, 2 + 0.25)) << "scaled, then moved";
    const MaterialTexture few = mtl_material("map_Kd -o .5 -s 2 -clamp off 1 2.png").base_color_texture;
    EXPECT_EQ(few.path, "folder/1 2.png");
    EXPECT_EQ(few.wrap_s, "periodic");
    EXPECT_EQ(placed_uv(few, V2d(0.25, 0.5)), V2d(1, 0.5)) << "the second and third number may be left out";
}

TEST(Mtl, ATextureIsMultipliedByTheColour)
{
    EXPECT_EQ(mtl_material("Kd .5 .5 .5\nmap_Kd a.png").base_color, C4f(0.5f, 0.5f, 0.5f, 1));
    EXPECT_EQ(mtl_material("map_Kd a.png").base_color, C4f(1, 1, 1, 1));
    EXPECT_EQ(mtl_material("Kd 0 0 0\nmap_Kd a.png\nd .5").base_color, C4f(1, 1, 1, 0.5f)) << "not a black texture";
    EXPECT_EQ(mtl_material("Kd 0 0 0").base_color, C4f(0, 0, 0, 1));
}

TEST(Mtl, AnImageOfOpacity)
{
    const Material cut = mtl_material("map_Kd a.png\nmap_d m.png");
    EXPECT_EQ(cut.opacity_texture.path, "folder/m.png");
    EXPECT_EQ(cut.alpha_mode, AlphaMode::blend);
    const Material same = mtl_material("map_d a.png\nmap_Kd a.png");
    EXPECT_FALSE(same.opacity_texture.exists()) << "the alpha of its colour";
    EXPECT_EQ(same.alpha_mode, AlphaMode::blend);
    EXPECT_TRUE(mtl_material("map_Kd a.png\nmap_d -imfchan r a.png").opacity_texture.exists());
    EXPECT_EQ(mtl_material("map_Kd a.png").alpha_mode, AlphaMode::opaque);
}

TEST(Mtl, OnlyNormIsANormalMap)
{
    const Material material = mtl_material("norm -bm .5 n.png\nmap_Bump -bm 2 h.png\nbump h.png\ndisp h.png");
    EXPECT_EQ(material.normal_texture.path, "folder/n.png");
    EXPECT_EQ(material.normal_scale, 0.5f);
    for (const char* heights : { "map_Bump h.png", "map_bump h.png", "bump h.png" })
        EXPECT_FALSE(mtl_material(heights).normal_texture.exists()) << heights;
}

TEST(Mtl, HeightsAreKnownToBeThere)
{
    for (const char* heights : { "map_Bump -bm 2 h.png", "bump h.png", "disp h.png", "map_disp h.png" })
        EXPECT_TRUE(mtl_material(heights).has_heights) << heights;
    for (const char* none : { "norm n.png", "map_Kd a.png", "bump", "map_Bump -bm 2" })
        EXPECT_FALSE(mtl_material(none).has_heights) << none;
}
