// SPDX-License-Identifier: Apache-2.0
// The error of a bake, against visibility that is known in closed form.
#include "closed_forms.h"

using namespace vmlight;
using namespace vmlight::closed_forms;

TEST(VismapSamplerError, EveryPointOfASphericalCavitySeesTheSameOpening)
{
    // The cap above a height is cut off; every point inside sees h / 2R of it, h the height of the cap.
    const int rings = 48;
    for (int cut : { 12, 24 }) {
        Mesh cavity = sphere(V3d(0), 1, rings, true);
        const double top = std::cos(kPi * cut / rings);
        std::vector<std::array<uint32_t, 3>> kept;
        for (const auto& t : cavity.triangles)
            if ((cavity.positions[t[0]].z + cavity.positions[t[1]].z + cavity.positions[t[2]].z) / 3 < top)
                kept.push_back(t);
        cavity.triangles.swap(kept);
        for (const Rate& rate : kRates) {
            const BakedMap map(cavity, {}, map_params(64, 64, 256, rate.sampler));
            double sum = 0, squares = 0, texels = 0;
            map.each_covered([&](const Texel& t, int, int) {
                const double error = t.visibility - (1 - top) / 2;
                sum += error, squares += error * error, ++texels;
            });
            ASSERT_GT(texels, 1000);
            // Facets lie inside the sphere by up to (pi / 48)^2 / 2 = 2e-3 of its radius.
            EXPECT_LE(std::sqrt(squares / texels), 1.1 * bound(rate.visibility, 256) + 3e-3) << rate.sampler << cut;
            EXPECT_LE(std::abs(sum / texels), 3e-3) << rate.sampler << cut;
        }
    }
}

TEST(VismapSamplerError, TheErrorOfEverySamplerFallsFasterThanThatOfChance)
{
    const Truth truth { 0.483363, V3d(-0.102987, 0, 0.239313) };
    const BakeScenePointer scene = shared_scene(floor_facing_z(kTiny), { sphere(V3d(0.4, 0, 1.3), 1, 128) });
    for (const Rate& rate : kRates) {
        const MapError few = error_of({ scene, map_params(32, 32, 16, rate.sampler) }, truth);
        const MapError many = error_of({ scene, map_params(32, 32, 1024, rate.sampler) }, truth);
        const double v = std::log(few.visibility / many.visibility) / std::log(64.0);
        const double d = std::log(few.direction / many.direction) / std::log(64.0);
        // Measured: fibonacci .82 .82, sobol .75 .78, halton .72 .74; chance has .5. And chance has an error of
        // sqrt(V (1 - V) / N) = .0156 at 1024 rays.
        EXPECT_GT(v, 0.68) << rate.sampler;
        EXPECT_GT(d, 0.68) << rate.sampler;
        EXPECT_LT(many.visibility, 0.0156 / 4) << rate.sampler;
    }
}

TEST(VismapSamplerError, TheErrorThatIsStatedIsTheDistanceToTheTruth)
{
    const double phi = std::atan(1.5);
    const struct
    {
        const char* name;
        std::vector<Mesh> occluders;
        double visibility;
    } scenes[] = { { "wall", { turned(wall_at_minus_x(-1), 0.7) }, 0.5 },
                   { "corner", { turned(wall_at_minus_x(-1), 2.2), turned(wall_at_minus_y(-1), 2.2) }, 0.25 },
                   { "low wall",
                     { turned(rectangle(V3d(1, -kFar, 0), V3d(0, 2 * kFar, 0), V3d(0, 0, 1.5)), 1.1) },
                     (1 + std::cos(phi)) / 2 },
                   { "ball", { sphere(V3d(0, 0, 2), 1, 100) }, 0.75 } };
    const int side = 48;
    for (const auto& scene : scenes)
        for (int samples : { 16, 64, 256, 1024 }) {
            VismapParams params = map_params(side, side, samples);
            params.channels = { "error" };
            params.seed = samples;
            const BakedMap map(floor_facing_z(kTiny), scene.occluders, params);
            const MapError error = error_of(map, { scene.visibility, V3d(0) });
            SCOPED_TRACE(testing::Message() << scene.name << ", " << samples << " rays");
            // Of 2304 texels each, so that chance leaves 3 % of a root mean square; facets add 2e-4 at most. A wall
            // through the texel hides exactly half of a lattice: a ray on its edge in one texel of 1500 is all the
            // error there is.
            EXPECT_NEAR(error.visibility, map.report.error, 0.12 * map.report.error + 2e-4 + 1.0 / samples / 40);
            EXPECT_LE(std::abs(error.visibility_bias), 4 * map.report.error / side + 2e-4);
        }
}
