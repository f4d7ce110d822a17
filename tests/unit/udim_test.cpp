// SPDX-License-Identifier: Apache-2.0
#include "temporary_folder.h"

#include <vmlight/uv/udim.h>

#include <gtest/gtest.h>

using namespace vmlight;

namespace {

std::vector<int> udims(const std::string& text)
{
    std::vector<int> tiles;
    std::string error;
    EXPECT_TRUE(parse_udims(tiles, text, error)) << error;
    return tiles;
}

std::string list_refusal(const std::string& text)
{
    std::vector<int> tiles;
    std::string error;
    EXPECT_FALSE(parse_udims(tiles, text, error)) << text;
    return error;
}

Mesh one_triangle(Imath::V2f a, Imath::V2f b, Imath::V2f c)
{
    Mesh mesh;
    mesh.positions = { Imath::V3d(0, 0, 0), Imath::V3d(1, 0, 0), Imath::V3d(0, 1, 0) };
    mesh.normals.assign(3, Imath::V3f(0, 0, 1));
    mesh.uvs = { a, b, c };
    mesh.triangles = { { 0, 1, 2 } };
    return mesh;
}

} // namespace

TEST(Udim, TilesAreNumberedTenAcross)
{
    EXPECT_EQ(udim_corner(1001), Imath::V2f(0, 0));
    EXPECT_EQ(udim_corner(1002), Imath::V2f(1, 0));
    EXPECT_EQ(udim_corner(1010), Imath::V2f(9, 0));
    EXPECT_EQ(udim_corner(1011), Imath::V2f(0, 1));
    EXPECT_EQ(udim_corner(1132), Imath::V2f(1, 13));
}

TEST(Udim, AListIsSortedAndEachTileComesOnce)
{
    EXPECT_EQ(udims("1011,1001-1003,1002"), (std::vector<int> { 1001, 1002, 1003, 1011 }));
    EXPECT_EQ(list_refusal("1001-"), "\"1001-\" is not a list of UDIM tiles; expected something like 1001-1003,1011");
    EXPECT_EQ(list_refusal("1001x"), "\"1001x\" is not a list of UDIM tiles; expected something like 1001-1003,1011");
    EXPECT_EQ(list_refusal("all"), "\"all\" is not a list of UDIM tiles; expected something like 1001-1003,1011");
    EXPECT_EQ(list_refusal(""), "\"\" is not a list of UDIM tiles; expected something like 1001-1003,1011");
    EXPECT_EQ(list_refusal("999-1001"), "999 is not a UDIM tile; expected 1001 to 9999");
}

TEST(Udim, AFilesNameSaysItsTileInItsLastPart)
{
    EXPECT_EQ(udim_from_name("hero.1011.lightmap"), 1011);
    EXPECT_EQ(udim_from_name("/a.b/hero.v2.9999.lightmap"), 9999);
    for (const char* name : { "hero.lightmap", "1011.lightmap", ".1011.lightmap", "hero.1000.lightmap",
                              "hero.01011.lightmap", "hero.101a.lightmap", "hero_1011.lightmap",
                              "hero.1011.v2.lightmap", "hero.1011", "hero", "a.1011.b/hero.lightmap", "" })
        EXPECT_EQ(udim_from_name(name), 0) << name;
}

TEST(Udim, APatternFindsTheFilesThatExist)
{
    const TemporaryFolder folder;
    for (const char* name : { "hero.1011.exr", "hero.1001.exr", "hero.100.exr", "hero.0999.exr", "hero.1002.exr.bak",
                              "other.1003.exr", "hero.<UDIM>.exr" })
        folder.write(name, "x");
    const std::string pattern = folder / "hero.<UDIM>.exr";
    EXPECT_TRUE(has_udim_pattern(pattern));
    EXPECT_FALSE(has_udim_pattern("hero.1001.exr"));
    EXPECT_EQ(existing_udims(pattern), (std::vector<int> { 1001, 1011 }));
    EXPECT_EQ(udim_path("a.<UDIM>.exr", 1021), "a.1021.exr");
    EXPECT_TRUE(existing_udims(folder / "missing/hero.<UDIM>.exr").empty());
}

TEST(Udim, AMeshIsInTheTilesThatItsTrianglesReach)
{
    using Imath::V2f;
    EXPECT_EQ(mesh_udims(one_triangle(V2f(0, 0), V2f(1, 0), V2f(1, 1))), (std::vector<int> { 1001 }));
    EXPECT_EQ(mesh_udims(one_triangle(V2f(1, 0), V2f(2, 0), V2f(2, 1))), (std::vector<int> { 1002 }));
    EXPECT_EQ(mesh_udims(one_triangle(V2f(0.5f, 0.5f), V2f(1.5f, 0.5f), V2f(1.5f, 1.5f))),
              (std::vector<int> { 1001, 1002, 1011, 1012 }));
    EXPECT_TRUE(mesh_udims(one_triangle(V2f(NAN, 0), V2f(1, 0), V2f(1, 1))).empty());
    EXPECT_TRUE(mesh_udims(one_triangle(V2f(-2, -2), V2f(-1, -2), V2f(-1, -1))).empty());
    EXPECT_TRUE(mesh_udims(one_triangle(V2f(1e30f, 0), V2f(1e30f, 0), V2f(1e30f, 1))).empty());
    Mesh bare = one_triangle(V2f(0), V2f(0), V2f(0));
    bare.uvs.clear();
    EXPECT_TRUE(mesh_udims(bare).empty());
}
