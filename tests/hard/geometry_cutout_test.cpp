// SPDX-License-Identifier: Apache-2.0
// Cut-outs: textures that decide whether a ray is blocked.
#include "cutout_scene.h"
#include "hard_case.h"
#include "temporary_folder.h"

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/stage/cutouts.h>
#include <vmlight/trace/occluder.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace vmlight;
using namespace vmlight::cutout_scene;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// Rays from the origin upwards, and which of them pass.
std::vector<uint8_t> passed(const Mesh& mesh, CutoutMode mode)
{
    Occluder occluder;
    std::string error;
    EXPECT_TRUE(occluder.build({ &mesh }, {}, 1, error, mode)) << error;
    std::vector<uint8_t> lanes;
    std::mt19937 random(5);
    std::uniform_real_distribution<float> in(-1, 1);
    for (int i = 0; i < 1000; ++i) {
        RayFan fan(16);
        for (int k = 0; k < 16; ++k) {
            const V3f d = V3f(in(random), in(random), 1).normalized();
            fan.x[k] = d.x, fan.y[k] = d.y, fan.z[k] = d.z;
        }
        fan.lanes.assign(fan.lanes.size(), 0xff);
        occluder.clear_blocked(fan, V3f(0), std::numeric_limits<float>::infinity());
        lanes.insert(lanes.end(), fan.lanes.begin(), fan.lanes.end());
    }
    return lanes;
}

// The share of points whose cell says something else if it is taken for what its middle is.
double wrong_by_centres(const TriangleOpacity& triangle, int level)
{
    const MicromapGrid grid { level };
    const int n = 1 << level;
    std::vector<double> middle(size_t(grid.count()));
    for (int j = 0; j < n; ++j)
        for (int i = 0; i + j < n; ++i)
            for (const bool upper : { false, true })
                if (!upper || i + j < n - 1)
                    middle[size_t(grid.index(i, j, upper))]
                        = triangle.at((i + (upper ? 2 : 1) / 3.0) / n, (j + (upper ? 2 : 1) / 3.0) / n);
    std::mt19937 random(6);
    std::uniform_real_distribution<double> in(0, 1);
    int wrong = 0;
    constexpr int kPoints = 100000;
    for (int i = 0; i < kPoints; ++i) {
        double u = in(random), v = in(random);
        if (u + v > 1)
            u = 1 - u, v = 1 - v;
        wrong += middle[size_t(grid.cell(u, v))] != triangle.at(u, v);
    }
    return double(wrong) / kPoints;
}

} // namespace

TEST(Geometry, CellsOfALeafAndItsTexture)
{
    HardCase row("A toothed leaf whose texture was sorted into cells beforehand");
    const MaterialOpacity rule = material(AlphaMode::mask, leaf(128));
    const std::array<V2f, 3> uvs { V2f(0, 0), V2f(1, 0), V2f(0, 1) };
    const double wrong = wrong_by_centres(TriangleOpacity(rule, { uvs, uvs }), 5);
    EXPECT_GT(wrong, 0.005);
    row.naive(format("a cell is what its middle is: {:.0f} % of the hits are wrong", 100 * wrong));
    for (const AlphaPointer& alpha : { leaf(128), leaf(37), checker(32), checker(2) })
        for (const double repeats : { 1.0, 0.3, 7.7 }) {
            const Mesh mesh = with_material(card(1.5, 1, repeats), material(AlphaMode::mask, alpha));
            EXPECT_EQ(passed(mesh, CutoutMode::micromaps), passed(mesh, CutoutMode::every_hit)) << repeats;
        }
    row.ours("a cell knows the least and greatest texel that its points touch: no hit differs from the texture's");
}

TEST(Geometry, CutOutsBeyondTheTexture)
{
    HardCase row(
        "Cut-outs with UVs of 1e38, NaN, all in one point, on textures of one texel or with alpha of NaN, -1 and 9");
    row.naive("a texel number that no integer holds; NaN at least the cutoff is false: a hole");
    const float most = std::numeric_limits<float>::max();
    const std::vector<std::array<V2f, 2>> corners { { V2f(-most, -most), V2f(most, most) },
                                                    { V2f(1e9f, 1e9f), V2f(1e9f, 1e9f) },
                                                    { V2f(kNan, 0), V2f(1, 1) },
                                                    { V2f(0.5f, 0.5f), V2f(0.5f, 0.5f) } };
    const float values[] = { kNan, -1, 9, 1 };
    const AlphaPointer broken = texture(2, 2, [&](int x, int y) { return values[2 * y + x]; });
    const AlphaPointer open = texture(1, 1, [](int, int) { return 0.0f; });
    for (const auto& [low, high] : corners)
        for (const AlphaPointer& alpha : { broken, open })
            for (const AlphaMode mode : { AlphaMode::mask, AlphaMode::blend }) {
                Mesh mesh;
                scenes::add_quad(mesh, V3d(-1, -1, 1), V3d(1, -1, 1), V3d(1, 1, 1), V3d(-1, 1, 1), low, high);
                mesh = with_material(mesh, material(mode, alpha));
                const std::vector<uint8_t> rays = passed(mesh, CutoutMode::micromaps);
                EXPECT_EQ(rays, passed(mesh, CutoutMode::every_hit));
                if (std::isnan(low.x)) {
                    EXPECT_EQ(rays[0], 0) << "no texture";
                } else if (alpha == open) {
                    EXPECT_EQ(rays[0], 0xff);
                }
            }
    row.ours("defined: without UVs there is no texture, NaN is opaque, the rest is brought to [0, 1]");
}

TEST(Geometry, CutOutsWithoutTheirTexture)
{
    HardCase row("A leaf whose texture of opacity is not there, or is no image");
    row.naive("a solid card, exit 0");
    const TemporaryFolder folder;
    folder.write("broken.png", "no image");
    for (const char* name : { "none.png", "broken.png" }) {
        folder.write("a.mtl", std::string("newmtl Leaf\nmap_d ") + name + "\n");
        Mesh mesh;
        std::string error;
        ASSERT_TRUE(read_mesh(mesh,
                              folder.write("a.obj",
                                           "mtllib a.mtl\nusemtl Leaf\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n"
                                           "f 1/1 2/1 3/1\n"),
                              {}, error));
        EXPECT_FALSE(read_cutouts(mesh, {}, nullptr, error)) << name;
        EXPECT_THAT(error,
                    testing::AllOf(testing::HasSubstr(name), testing::HasSubstr("\"Leaf\""),
                                   testing::HasSubstr("--cutouts off")));
    }
    row.ours("refused, with its name and the flag that does without");
}
