// SPDX-License-Identifier: Apache-2.0
// Directions that cancel, and lookups where the map ends.
#include "hard_case.h"

#include "stack_maps.h"

#include <cmath>

using namespace vmlight;
using Imath::V3d;
using Imath::V3f;
using scene::color;
using scene::lit;
using scene::model;
using scene::one_texel;

namespace {

V3f naive_lookup(const OIIO::ImageBuf& cfem, const V3f& b)
{
    const V3f n = b / std::sqrt(b.dot(b)); // not Imath's, which guards
    if (!std::isfinite(n.x))
        return V3f(NAN);
    const Imath::V2d at = latlong::position(V3d(n));
    const int x = int(at.x * cfem.spec().width), y = int(at.y * cfem.spec().height);
    return color(cfem, x, std::min(y, cfem.spec().height - 1));
}

} // namespace

TEST(Arithmetic, ATexelThatSeesAlikeOnAllSides)
{
    HardCase row("A slot open at both ends: the directions cancel, leaving only rounding",
                 "all formats that store unit bent normals: noise");
    const auto stack = scene::random_stack(16, 8);
    const V3f noise[] = { V3f(1e-8f, 0, 0), V3f(-1e-8f, 3e-9f, 0), V3f(0, 1e-9f, -1e-8f) };
    EXPECT_NE(naive_lookup(stack[0], noise[0]), naive_lookup(stack[0], noise[1]));
    row.naive("light from a random direction, different for each seed");
    for (const char* name : { "paper", "lobe" }) {
        const V3f expected = color(lit(one_texel(0.4f, V3f(0)), stack, model(name)));
        EXPECT_GT(expected.length(), 0.1f);
        for (const V3f& b : noise)
            EXPECT_EQ(color(lit(one_texel(0.4f, b), stack, model(name))), expected) << name;
    }
    row.ours("V times the mean light: bit-equal for |B| below 1e-6 V");
}

TEST(Arithmetic, ATexelThatSeesNothing)
{
    HardCase row("V = 0 and B = 0", "Filament, Fornos `normalize(acc)`: NaN (fully occluded texel)");
    const auto stack = scene::random_stack(16, 8);
    EXPECT_TRUE(std::isnan(naive_lookup(stack[0], V3f(0)).x));
    row.naive("0/0: NaN");
    for (const char* name : { "paper", "lobe", "auto" })
        for (float v : { 0.0f, -0.0f })
            EXPECT_EQ(color(lit(one_texel(v, V3f(0)), stack, model(name))), V3f(0)) << name;
    row.ours("0");
}

TEST(Arithmetic, VisibilitiesThatAreNone)
{
    HardCase row("V of -3, 2.1 or 255: a map that was graded or stored as integers, or the wrong image");
    const auto stack = scene::random_stack(16, 8);
    row.naive("255 times the light, exit code 0");
    for (const char* name : { "paper", "lobe" }) {
        for (float v : { -3.0f, 2.1f, 255.0f, 1e30f }) {
            OIIO::ImageBuf dst;
            EXPECT_FALSE(make_lightmap(dst, one_texel(v, V3f(0, 0.6f, 0)), stack, model(name)));
            EXPECT_NE(dst.geterror().find("outside [-2, 2] and so cannot be visibility, at pixel (0, 0)"),
                      std::string::npos);
        }
        const V3f light = color(lit(one_texel(1, V3f(0, 1.0f / 3, 0)), stack, model(name)));
        const V3f rung = color(lit(one_texel(1.2f, V3f(0, 0.4f, 0)), stack, model(name))); // by a filter
        EXPECT_LT((rung - 1.2f * light).length(), 1e-5f * light.length());
    }
    row.ours("refused outside [-2, 2], with the pixel; ringing from a filter is accepted");
}

TEST(Arithmetic, LookupsWhereTheMapEnds)
{
    HardCase row("Lookups exactly at a pole, on the seam and at texel corners, with directions of any length");
    EXPECT_TRUE(std::isnan(std::acos(std::nextafter(1.0f, 2.0f))));
    // A hair's breadth before the seam, in float.
    const float s = std::atan2(1e-9f, -1.0f) / float(2 * latlong::pi) + 0.5f;
    EXPECT_EQ(int(s * 16), 16);
    row.naive("acos(1 + 1e-7) is NaN; column 16 of 16 reads the next row, or past the end");
    for (const auto& [w, h] : { std::pair { 16, 8 }, { 5, 3 }, { 2, 1 }, { 1, 7 }, { 1, 1 } }) {
        const OIIO::ImageBuf map = scene::random_cfem(w, h);
        float low = 1, high = 0;
        for (OIIO::ImageBuf::ConstIterator<float> p(map); !p.done(); ++p)
            for (int c = 0; c < 3; ++c)
                low = std::min<float>(low, p[c]), high = std::max<float>(high, p[c]);
        for (int j = 0; j <= 2 * h; ++j)
            for (int i = 0; i <= 2 * w; ++i)
                for (const double length : { 1.0, 1 + 1e-6, 1e-3, 1e18 }) {
                    const V3f d(latlong::direction(0.5 * i / w, 0.5 * j / h) * length);
                    const V3f c = color(lit(one_texel(1, d), map));
                    for (int k = 0; k < 3; ++k)
                        EXPECT_TRUE(c[k] >= low - 1e-6f && c[k] <= high + 1e-6f) << d << " of " << w << "x" << h;
                }
        for (const float tiny : { 0.0f, -0.0f, 1e-9f, -1e-9f, 1e-38f, -1e-38f }) {
            const V3f seam = color(lit(one_texel(1, V3f(tiny, 0, -1)), map));
            const V3f across = color(lit(one_texel(1, V3f(-tiny, 0, -1)), map));
            EXPECT_LT((seam - across).length(), 1e-6f * float(w + h) + 1e-6f);
        }
    }
    row.ours("finite, within the map's range, continuous across the seam");
}

TEST(Arithmetic, AnglesNearThePole)
{
    HardCase row("The polar angle of directions 1e-6 to 1e-2 from the pole");
    double naive = 0, ours = 0;
    for (double angle = 1e-6; angle < 1e-2; angle *= 1.1) {
        const V3f d(float(std::sin(angle)), float(std::cos(angle)), 0);
        naive = std::max(naive, std::abs(double(std::acos(d.y)) - angle) / angle);
        ours = std::max(ours, std::abs(latlong::position(d).y * latlong::pi - angle));
    }
    EXPECT_GE(naive, 0.99);
    row.naive("acos(y) in float: up to 100 % error");
    EXPECT_LT(ours, 3e-7);
    row.ours("atan2: within 3e-7 radians");
}
