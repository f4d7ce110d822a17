// SPDX-License-Identifier: Apache-2.0
#include "scenes.h"

#include <vmlight/vismap.h>

#include <gtest/gtest.h>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

struct Texel
{
    float visibility;
    V3f direction;
};

class Map
{
public:
    Map(const Mesh& mesh, const std::vector<Mesh>& occluders, const VismapParams& params, int nthreads = 0)
    {
        EXPECT_TRUE(make_vismap(m_image, mesh, occluders, params, &report, nthreads)) << m_image.geterror();
    }
    Texel at(int x, int y) const
    {
        float p[4];
        m_image.getpixel(x, y, 0, p, 4);
        return { p[0], V3f(p[1], p[2], p[3]) };
    }
    Texel centre() const { return at(m_image.spec().width / 2, m_image.spec().height / 2); }
    const OIIO::ImageBuf& image() const { return m_image; }
    template <class Visit> void each(Visit&& visit) const
    {
        for (int y = 0; y < m_image.spec().height; ++y)
            for (int x = 0; x < m_image.spec().width; ++x)
                visit(at(x, y), x, y);
    }
    VismapReport report;

private:
    OIIO::ImageBuf m_image;
};

VismapParams one_texel(int samples, const char* sampler = "fibonacci")
{
    VismapParams params;
    params.resolution = { 1, 1 };
    params.samples = samples;
    params.sampler = sampler;
    params.margin = 0;
    return params;
}

// The sampler's error at n rays, four times its measured root mean square (tests/unit/sampling_test.cpp measures it).
double tolerance(int samples)
{
    return 4 * 0.35 * std::pow(samples, -0.75);
}

void expect_visibility(const Texel& texel, double visibility, V3d direction, double tolerance)
{
    EXPECT_NEAR(texel.visibility, visibility, tolerance);
    EXPECT_NEAR(texel.direction.x, direction.x, tolerance);
    EXPECT_NEAR(texel.direction.y, direction.y, tolerance);
    EXPECT_NEAR(texel.direction.z, direction.z, tolerance);
}

const double kFar = 1e5;

} // namespace

TEST(Vismap, AnOpenFloorSeesAllAlongItsNormal)
{
    VismapParams params = one_texel(64);
    params.resolution = { 8, 8 };
    Map(floor_facing_z(1), {}, params).each([](const Texel& t, int x, int y) {
        EXPECT_EQ(t.visibility, 1.0f) << x << ", " << y;
        EXPECT_LT((t.direction - V3f(0, 0, 2.0f / 3)).length(), 1e-6f) << x << ", " << y;
    });
}

TEST(Vismap, AWallOfFiniteHeightHidesAStrip)
{
    const double phi = std::atan(1.5), pi = M_PI;
    const Mesh wall = quad(V3d(1, -kFar, 0), V3d(1, -kFar, 1.5), V3d(1, kFar, 1.5), V3d(1, kFar, 0));
    const V3d direction(-(2 / (3 * pi)) * std::pow(std::sin(phi), 2), 0,
                        2.0 / 3 - 2 / (3 * pi) * (phi - std::sin(phi) * std::cos(phi)));
    EXPECT_NEAR((1 + std::cos(phi)) / 2, 0.777350, 1e-6);
    for (int samples : { 16, 64, 256, 4096, 65536 })
        expect_visibility(Map(floor_facing_z(0.5), { wall }, one_texel(samples)).centre(), (1 + std::cos(phi)) / 2,
                          direction, tolerance(samples));
}
