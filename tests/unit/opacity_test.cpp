// SPDX-License-Identifier: Apache-2.0
// Opacity of materials, point by point, and what a range of it promises.
#include "cutout_scene.h"

#include <vmlight/mesh/opacity.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace vmlight;
using namespace vmlight::cutout_scene;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr TextureWrap kWraps[] = { TextureWrap::clamp, TextureWrap::periodic, TextureWrap::mirror };

} // namespace

TEST(Opacity, AMaskIsAllOrNothingAndABlendIsItsAlpha)
{
    EXPECT_EQ(opacity_of(AlphaMode::opaque, 0, 0.5), 1);
    EXPECT_EQ(opacity_of(AlphaMode::mask, 0.5, 0.5), 1) << "glTF: at least the cutoff";
    EXPECT_EQ(opacity_of(AlphaMode::mask, std::nextafter(0.5, 0), 0.5), 0);
    EXPECT_EQ(opacity_of(AlphaMode::mask, 1, 1.01), 0) << "glTF: above 1 all of it is transparent";
    EXPECT_EQ(opacity_of(AlphaMode::blend, 0.3, 0.5), 0.3);
    EXPECT_EQ(opacity_of(AlphaMode::blend, -2, 0.5), 0);
    EXPECT_EQ(opacity_of(AlphaMode::blend, 7, 0.5), 1);
    for (AlphaMode mode : { AlphaMode::mask, AlphaMode::blend })
        EXPECT_EQ(opacity_of(mode, kNan, 0.5), 1);
}

TEST(Opacity, TexelsAreAtTheirCentresAndBetweenThemLinear)
{
    const AlphaPointer alpha = texture(
        2, 2, [](int x, int y) { return x ? (y ? 1.0f : 0.5f) : (y ? 0.25f : 0.0f); }, TextureWrap::clamp,
        TextureWrap::clamp);
    EXPECT_EQ(alpha->lookup(V2d(0.25, 0.25)), 0);
    EXPECT_EQ(alpha->lookup(V2d(0.75, 0.25)), 0.5);
    EXPECT_EQ(alpha->lookup(V2d(0.25, 0.75)), 0.25);
    EXPECT_EQ(alpha->lookup(V2d(0.5, 0.25)), 0.25);
    EXPECT_EQ(alpha->lookup(V2d(0.5, 0.5)), 0.4375);
    EXPECT_EQ(alpha->lookup(V2d(-5, -5)), 0);
    EXPECT_EQ(alpha->lookup(V2d(1e300, 1e300)), 1);
}

TEST(Opacity, WrapsFollowTheirNames)
{
    const auto ramp = [](int x, int) { return float(x) / 4; };
    const auto at = [&](TextureWrap wrap, double s, bool nearest = true) {
        return texture(4, 1, ramp, wrap, wrap, nearest)->lookup(V2d(s, 0.5));
    };
    EXPECT_EQ(at(TextureWrap::periodic, 1.1), 0);
    EXPECT_EQ(at(TextureWrap::periodic, -0.1), 0.75);
    EXPECT_EQ(at(TextureWrap::mirror, 1.1), 0.75);
    EXPECT_EQ(at(TextureWrap::mirror, -0.3), 0.25);
    EXPECT_EQ(at(TextureWrap::mirror, 2.3), 0.25);
    EXPECT_EQ(at(TextureWrap::clamp, 9), 0.75);
    EXPECT_EQ(at(TextureWrap::clamp, -9), 0);
    EXPECT_EQ(at(TextureWrap::periodic, 0, false), 0.375) << "between the last and the first";
}

TEST(Opacity, WhatIsNoAlphaIsMadeOne)
{
    const float values[] = { kNan, 3, -1, std::numeric_limits<float>::infinity(), 1e-42f };
    const AlphaPointer alpha = texture(
        5, 1, [&](int x, int) { return values[x]; }, TextureWrap::clamp, TextureWrap::clamp, true);
    const double wanted[] = { 1, 1, 0, 1, 0 };
    for (int x = 0; x < 5; ++x)
        EXPECT_EQ(alpha->lookup(V2d((x + 0.5) / 5, 0.5)), wanted[x]) << x;
}

TEST(Opacity, ARangeHoldsTheTexelsThatABoxTouchesAndNoOthers)
{
    std::mt19937 random(3);
    const auto number
        = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
    for (int run = 0; run < 3000; ++run) {
        const int width = 1 + int(random() % 37), height = 1 + int(random() % 19);
        const bool nearest = run % 3 == 0;
        const TextureWrap wrap_s = kWraps[random() % 3], wrap_t = kWraps[random() % 3];
        std::vector<float> texels(size_t(width) * size_t(height));
        for (float& texel : texels)
            texel = float(random() % 1000) / 1000;
        const AlphaTexture alpha(width, height, texels, wrap_s, wrap_t, nearest);
        const V2d low { number(-3, 3), number(-3, 3) };
        const double reach = run % 5 == 0 ? 3 : 0.3;
        const V2d high = low + V2d { number(0, reach), number(0, reach) };
        const auto touched = [&](double from, double to, int n, TextureWrap wrap) {
            std::vector<int> found;
            const double shift = nearest ? 0 : 0.5;
            for (int64_t i = int64_t(std::floor(from * n - shift)); i <= int64_t(std::floor(to * n - shift)) + !nearest;
                 ++i)
                found.push_back(wrapped_texel(i, n, wrap));
            return found;
        };
        AlphaRange wanted;
        for (int y : touched(low.y, high.y, height, wrap_t))
            for (int x : touched(low.x, high.x, width, wrap_s)) {
                const double value = texels[size_t(y) * size_t(width) + size_t(x)];
                wanted.add(value, value);
            }
        const AlphaRange range = alpha.range(low, high);
        ASSERT_EQ(range.low, wanted.low) << run;
        ASSERT_EQ(range.high, wanted.high) << run;
        for (int i = 0; i < 20; ++i) {
            const double value = alpha.lookup(V2d { number(low.x, high.x), number(low.y, high.y) });
            ASSERT_GE(value, range.low) << run;
            ASSERT_LE(value, range.high) << run;
        }
    }
}

TEST(Opacity, AMaterialIsOpaqueWhereNoTexelLetsLightThrough)
{
    const AlphaPointer high = texture(4, 4, [](int x, int) { return 0.6f + 0.1f * float(x); });
    EXPECT_TRUE(material(AlphaMode::mask, high, 1, 0.59).is_opaque());
    EXPECT_FALSE(material(AlphaMode::mask, high, 0.9, 0.59).is_opaque());
    EXPECT_FALSE(material(AlphaMode::blend, high).is_opaque());
    EXPECT_TRUE(material(AlphaMode::blend, nullptr).is_opaque());
    EXPECT_FALSE(material(AlphaMode::blend, nullptr, 0.99).is_opaque());
    EXPECT_TRUE(material(AlphaMode::opaque, high, 0).is_opaque());
}

TEST(Opacity, TwoTexturesAreMultipliedEachByItsOwnUvs)
{
    MaterialOpacity both
        = material(AlphaMode::blend,
                   texture(
                       2, 1, [](int x, int) { return x ? 0.5f : 1.0f; }, TextureWrap::clamp, TextureWrap::clamp, true));
    both.textures[1].image = texture(
        1, 2, [](int, int y) { return y ? 0.25f : 1.0f; }, TextureWrap::clamp, TextureWrap::clamp, true);
    both.textures[1].uv_set = 1;
    both.factor = 0.5;
    const std::array<V2f, 3> unit { V2f(0, 0), V2f(1, 0), V2f(0, 1) }, turned { V2f(0, 0), V2f(0, 1), V2f(1, 0) };
    const TriangleOpacity same(both, { unit, unit }), other(both, { unit, turned });
    EXPECT_EQ(same.at(0.1, 0.1), 0.5 * 0.25) << "v is up: the second texture's lower row";
    EXPECT_EQ(same.at(0.7, 0.1), 0.5 * 0.5 * 0.25);
    EXPECT_EQ(same.at(0.1, 0.7), 0.5);
    EXPECT_EQ(other.at(0.7, 0.1), 0.5 * 0.5);
}

TEST(Opacity, ATransformMovesTheTexture)
{
    MaterialOpacity moved
        = material(AlphaMode::blend,
                   texture(
                       2, 1, [](int x, int) { return float(x); }, TextureWrap::periodic, TextureWrap::periodic, true));
    moved.textures[0].uv_transform = Imath::M33d(1, 0, 0, 0, 1, 0, 0.5, 0, 1);
    const std::array<V2f, 3> unit { V2f(0, 0), V2f(1, 0), V2f(0, 1) };
    EXPECT_EQ(TriangleOpacity(moved, { unit, unit }).at(0.1, 0.1), 1);
    EXPECT_EQ(TriangleOpacity(moved, { unit, unit }).at(0.6, 0.1), 0);
}

TEST(Opacity, WithoutUvsOnlyTheFactorCounts)
{
    const MaterialOpacity open = material(AlphaMode::mask, texture(1, 1, [](int, int) { return 0.0f; }));
    for (const V2f& broken : { V2f(kNan, 0), V2f(0, std::numeric_limits<float>::infinity()) }) {
        const std::array<V2f, 3> uvs { V2f(0, 0), broken, V2f(0, 1) };
        EXPECT_EQ(TriangleOpacity(open, { uvs, uvs }).at(0.2, 0.2), 1);
        EXPECT_TRUE(TriangleOpacity(open, { uvs, uvs }).is_constant());
    }
    const std::array<V2f, 3> uvs { V2f(0, 0), V2f(1, 0), V2f(0, 1) };
    EXPECT_EQ(TriangleOpacity(open, { uvs, uvs }).at(0.2, 0.2), 0);
}

TEST(Opacity, APartOfAMeshKeepsItsUvs)
{
    Mesh mesh = with_material(foliage(3, 1), material(AlphaMode::mask, checker(2)));
    auto opacity = std::make_shared<MeshOpacity>(*mesh.opacity);
    opacity->uvs.resize(2);
    for (size_t i = 0; i < 3 * mesh.triangles.size(); ++i)
        opacity->uvs[1].push_back(V2f(float(i), 0));
    opacity->materials[0].textures[0].uv_set = 1;
    mesh.opacity = opacity;
    const std::shared_ptr<const MeshOpacity> part = opacity_part(*mesh.opacity, { 1, 4 });
    ASSERT_EQ(part->uvs[1].size(), 6u);
    EXPECT_EQ(part->uvs[1][0], V2f(3, 0));
    EXPECT_EQ(part->uvs[1][3], V2f(12, 0));
    EXPECT_EQ(texture_uvs(mesh, 4, opacity->materials[0].textures[0])[0], V2f(12, 0));
    opacity->materials[0].textures[0].uv_set = 0;
    EXPECT_EQ(texture_uvs(mesh, 4, opacity->materials[0].textures[0])[0], mesh.uvs[mesh.triangles[4][0]]);
}
