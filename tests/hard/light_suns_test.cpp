// SPDX-License-Identifier: Apache-2.0
// Suns that are split off an environment: found wherever they are, and never forgotten.
#include "hard_case.h"

#include "closed_forms.h"
#include "lightmap_scene.h"
#include "sun_sky.h"

#include <vmlight/base/format.h>
#include <vmlight/cfem/cfem.h>
#include <vmlight/lightmap/sun_light.h>
#include <vmlight/vismap/sun_visibility.h>

#include <OpenImageIO/imagebuf.h>

using namespace vmlight;
using Imath::V3d;
using Imath::V3f;

TEST(Light, ASunOnThePoleAndTheSeam)
{
    HardCase row("A sun in a pole of the map, beside it, and on the seam");
    double naive = 0;
    for (const V3d& place : { V3d(0, 1, 0), V3d(0, -1, 0), sun_sky::at_angles(70, 89.7), V3d(0, 0, -1) }) {
        sun_sky::Sky sky { sun_sky::gray_sky, { { place, 0.265, V3d(9, 9, 9) } } };
        const Environment env = sky.environment(512);
        SunSplit split;
        std::string error;
        ASSERT_TRUE(split.find(env, false, error)) << error;
        ASSERT_EQ(split.suns().size(), 1u) << place;
        // The mean of the pixel coordinates of the light.
        double s = 0, t = 0, all = 0, energy = 0;
        std::vector<float> rgb(3 * 512);
        for (int y = 0; y < 256; ++y) {
            ASSERT_TRUE(env.read(OIIO::ROI(0, 512, y, y + 1, 0, 1, 0, 3), rgb.data(), error));
            for (int x = 0; x < 512; ++x)
                if (rgb[size_t(3 * x)] > 2) {
                    s += (x + 0.5) / 512 * double(rgb[size_t(3 * x)]);
                    t += (y + 0.5) / 256 * double(rgb[size_t(3 * x)]);
                    all += double(rgb[size_t(3 * x)]);
                    energy += double(rgb[size_t(3 * x)]) * latlong::row_solid_angle(y, 256) / 512;
                }
        }
        // A pixel is .7 degrees wide, and does not tell where in it the sun is.
        EXPECT_LT(sun_sky::degrees_between(split.suns()[0].disc.direction, place), 0.15) << place;
        EXPECT_NEAR(split.suns()[0].color[0] * M_PI, energy, 0.01 * energy) << place;
        naive = std::max(naive, sun_sky::degrees_between(latlong::direction(s / all, t / all), place));
    }
    row.naive(format("the mean of its pixels' coordinates is {:.0f} degrees off", naive));
    EXPECT_GT(naive, 90);
    row.ours("one disc, within 0.15 degrees and 1 % of its light");
}

TEST(Light, ASkyWithoutItsSun)
{
    HardCase row("A filtered environment whose sun was split off, lit by a program that does not know");
    sun_sky::Sky sky { sun_sky::gray_sky, { { V3d(0, 0, 1), 0.265, V3d(30, 30, 30) } } };
    const Environment env = sky.environment(512);
    SunSplit split;
    std::string error;
    OIIO::ImageBuf rest, whole, lit;
    ASSERT_TRUE(split.find(env, false, error)) << error;
    ASSERT_TRUE(make_cfem(rest, split.rest(env)) && make_cfem(whole, env));
    const OIIO::ImageBuf open = scene::one_texel(1, V3f(0, 0, 2.0f / 3));
    ASSERT_TRUE(make_lightmap(lit, open, rest)) << lit.geterror();
    const float dark = lit.getchannel(0, 0, 0, 0);
    ASSERT_TRUE(make_lightmap(lit, open, whole)) << lit.geterror();
    const float bright = lit.getchannel(0, 0, 0, 0);
    row.naive(format("a surface that faces the sun has {:.0f} % of its light", 100 * double(dark / bright)));
    EXPECT_LT(dark, 0.2f * bright);

    rest.specmod().attribute(kSunsAttribute, suns_text(split.suns()));
    EXPECT_FALSE(make_lightmap(lit, open, rest));
    EXPECT_NE(lit.geterror().find("its suns were split off"), std::string::npos);
    const SunLight suns { split.suns(), open.roi(), { float(disc_mean_length(split.suns()[0].disc.half_angle)) } };
    ASSERT_TRUE(make_lightmap(lit, open, OIIO::cspan<OIIO::ImageBuf>(&rest, 1), &suns, {}, nullptr, 0, {}))
        << lit.geterror();
    EXPECT_NEAR(lit.getchannel(0, 0, 0, 0), bright, 0.01f * bright);
    row.ours("refused, with what to do; with its suns it has all of it");
}
