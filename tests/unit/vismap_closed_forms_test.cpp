// SPDX-License-Identifier: Apache-2.0
// Visibility that is known in closed form, against bakes with every sampler.
#include "closed_forms.h"

using namespace vmlight;
using namespace vmlight::closed_forms;

TEST(VismapClosedForms, AnOpenFloorSeesAllAlongItsNormal)
{
    for (const char* sampler : { "fibonacci", "sobol", "halton" })
        for (int samples : { 1, 2, 7, 16, 64, 1000 })
            BakedMap(floor_facing_z(1), {}, map_params(8, 8, samples, sampler)).each([&](const Texel& t, int, int) {
                EXPECT_EQ(t.visibility, 1.0f) << sampler << " " << samples;
                EXPECT_LT((t.direction - V3f(0, 0, 2.0f / 3)).length(), 1e-7f) << sampler << " " << samples;
            });
}

TEST(VismapClosedForms, AnOpenFloorSeesAllUniformlyToo)
{
    VismapParams params = map_params(8, 8, 64);
    params.measure = "uniform";
    BakedMap(floor_facing_z(1), {}, params).each([](const Texel& t, int, int) {
        EXPECT_EQ(t.visibility, 1.0f);
        EXPECT_LT((t.direction - V3f(0, 0, 2.0f / 3)).length(), 5 * bound(0.8, 64));
    });
}

TEST(VismapClosedForms, ATexelAtTheFootOfAWallSeesHalf)
{
    const Truth truth { 0.5, V3d(2 / (3 * kPi), 0, 1.0 / 3), 0.5 };
    EXPECT_NEAR(std::atan2(truth.direction.x, truth.direction.z) * 180 / kPi, 32.48, 0.005);
    expect_truth({ wall_at_minus_x(-kTiny) }, truth);
}

TEST(VismapClosedForms, HowFarAnEndlessWallIsDoesNotMatter)
{
    const double angle = 0.7;
    const Truth truth { 0.5, turned(V3d(2 / (3 * kPi), 0, 1.0 / 3), angle), 0.5 };
    for (double distance : { 0.01, 1.0, 10.0 })
        expect_truth({ turned(wall_at_minus_x(-distance), angle) }, truth, 2e-4);
}

TEST(VismapClosedForms, TwoWallsInACornerLeaveAQuarter)
{
    const Truth truth { 0.25, V3d(1 / (3 * kPi), 1 / (3 * kPi), 1.0 / 6), 0.25 };
    expect_truth({ wall_at_minus_x(-kTiny), wall_at_minus_y(-kTiny) }, truth);
    const double angle = 2.2;
    expect_truth({ turned(wall_at_minus_x(-1), angle), turned(wall_at_minus_y(-1), angle) },
                 { 0.25, turned(truth.direction, angle), 0.25 });
}

TEST(VismapClosedForms, ALowWallHidesAStripOfSky)
{
    const double phi = std::atan(1.5);
    const Truth truth { (1 + std::cos(phi)) / 2,
                        V3d(-(2 / (3 * kPi)) * std::pow(std::sin(phi), 2), 0,
                            2.0 / 3 - 2 / (3 * kPi) * (phi - std::sin(phi) * std::cos(phi))),
                        1 - phi / kPi };
    EXPECT_NEAR(truth.visibility, 0.777350, 1e-6);
    EXPECT_NEAR(truth.direction.x, -0.146912, 1e-6); // away from the wall at +x
    EXPECT_NEAR(truth.direction.z, 0.556053, 1e-6);
    EXPECT_NEAR(truth.uniform_visibility, 0.687167, 1e-6);
    const Mesh wall = rectangle(V3d(1, -kFar, 0), V3d(0, 2 * kFar, 0), V3d(0, 0, 1.5));
    expect_truth({ wall }, truth);
    expect_truth({ turned(wall, 1.1) }, { truth.visibility, turned(truth.direction, 1.1), truth.uniform_visibility });
}

TEST(VismapClosedForms, AGrooveShowsWhatItsAngleLeaves)
{
    const double table[][3] = { { 45, 0.106103, 0.060563 }, { 60, 0.159155, 0.130334 }, { 120, 0.159155, 0.536333 } };
    for (const auto& [degrees, bx, bz] : table) {
        const double angle = degrees * kPi / 180, low = kPi / 2 - angle;
        const Truth truth { std::pow(std::sin(angle / 2), 2),
                            V3d(2 / (3 * kPi) * (1 - std::pow(std::sin(low), 2)), 0,
                                4 / (3 * kPi) * ((kPi / 2 - low) / 2 - std::sin(2 * low) / 4)),
                            angle / kPi };
        EXPECT_NEAR(truth.direction.x, bx, 1e-6);
        EXPECT_NEAR(truth.direction.z, bz, 1e-6);
        SCOPED_TRACE(degrees);
        // The other face rises from the line x = -1.
        expect_truth(
            { rectangle(V3d(-1, -kFar, 0), V3d(0, 2 * kFar, 0), V3d(std::cos(angle), 0, std::sin(angle)) * kFar) },
            truth);
    }
}

TEST(VismapClosedForms, ADiscOverheadHidesTheZenith)
{
    const double c = 0.8 / std::sqrt(1 + 0.64);
    const Truth truth { c * c, V3d(0, 0, 2.0 / 3 * c * c * c), c };
    EXPECT_NEAR(truth.visibility, 0.390244, 1e-6);
    EXPECT_NEAR(truth.direction.z, 0.162522, 1e-6);
    expect_truth({ disc(V3d(0, 0, 0.8), 1) }, truth);
}

TEST(VismapClosedForms, ADiscAsideHidesItsFormFactor)
{
    const double r = 1, h = 0.8, s = 0.6, hs = h / s, rs = r / s, z = 1 + hs * hs + rs * rs;
    const double hidden = 0.5 * (1 - (z - 2 * rs * rs) / std::sqrt(z * z - 4 * rs * rs));
    EXPECT_NEAR(hidden, 0.5, 1e-12);
    const Mesh aside = disc(V3d(s, 0, h), r);
    for (const Rate& rate : kRates)
        for (int samples : { 16, 64, 256, 1024 }) {
            const BakedMap map(floor_facing_z(kTiny), { aside }, map_params(8, 8, samples, rate.sampler));
            const MapError error = error_of(map, { 1 - hidden, V3d(0) });
            EXPECT_LE(error.visibility, 1.4 * bound(rate.visibility, samples) + 2e-4) << rate.sampler << samples;
        }
}

TEST(VismapClosedForms, ThePitsFloorSeesTheZenithOnly)
{
    const double c = 0.8 / std::sqrt(1 + 0.64);
    const Truth truth { 1 - c * c, V3d(0, 0, 2.0 / 3 * (1 - c * c * c)), 1 - c };
    EXPECT_NEAR(truth.visibility, 0.609756, 1e-6);
    EXPECT_NEAR(truth.direction.z, 0.504144, 1e-6);
    expect_truth({ tube(1, 0.8) }, truth);
}

TEST(VismapClosedForms, ABallAboveHidesItsCap)
{
    const double table[][7] = { { 1, 1, 1.5, 0.829323, -0.118161, 0.561265, 0.832050 },
                                { 1, 1.3, 0.4, 0.483363, -0.102987, 0.239313, 0.677834 },
                                { 1, 2, 0, 0.75, 0, 0.433013, 0.866025 } };
    for (const auto& [radius, height, aside, v, bx, bz, uniform] : table) {
        const double d2 = aside * aside + height * height, d = std::sqrt(d2), k = std::sqrt(1 - radius * radius / d2);
        const V3d n(0, 0, 1), c(aside / d, 0, height / d);
        const double s = 2 * kPi * (1 - k), p = 2 * kPi * (1 - k * k * k) / 3;
        const Truth truth { 1 - radius * radius * height / (d2 * d),
                            n * (2.0 / 3) - (n * ((s - p) / 2) + c * ((3 * p - s) / 2 * n.dot(c))) / kPi, k };
        EXPECT_NEAR(truth.visibility, v, 1e-6);
        EXPECT_NEAR(truth.direction.x, bx, 1e-6);
        EXPECT_NEAR(truth.direction.z, bz, 1e-6);
        EXPECT_NEAR(truth.uniform_visibility, uniform, 1e-6);
        SCOPED_TRACE(testing::Message() << "height " << height << ", aside " << aside);
        expect_truth({ sphere(V3d(aside, 0, height), radius, 96) }, truth, 6e-4); // the facets cut off 5e-4 of it
    }
}

TEST(VismapClosedForms, AStandingRectangleHidesItsFormFactor)
{
    const double a = 1, b = 1.2, c = 0.7, x = a / b, y = c / b, l = std::sqrt(x * x + y * y);
    const double factor = (std::atan(1 / x) - x / l * std::atan(1 / l)) / (2 * kPi);
    EXPECT_NEAR(factor, 0.038138, 1e-6);
    const V3d corner(a, 0, 0), side1(0, b, 0), side2(0, 0, c);
    const Truth hidden = hidden_by_rectangle(corner, side1, side2);
    EXPECT_NEAR(hidden.visibility, factor, 1e-6);
    expect_truth({ rectangle(corner, side1, side2) }, without(hidden));
}

TEST(VismapClosedForms, ALyingRectangleHidesItsFormFactor)
{
    const double a = 1, b = 1.2, c = 0.7, x = a / c, y = b / c;
    const double lx = std::sqrt(1 + x * x), ly = std::sqrt(1 + y * y);
    const double factor = (x / lx * std::atan(y / lx) + y / ly * std::atan(x / ly)) / (2 * kPi);
    EXPECT_NEAR(factor, 0.187062, 1e-6);
    const V3d corner(0, 0, c), side1(a, 0, 0), side2(0, b, 0);
    const Truth hidden = hidden_by_rectangle(corner, side1, side2);
    EXPECT_NEAR(hidden.visibility, factor, 1e-6);
    expect_truth({ rectangle(corner, side1, side2) }, without(hidden));
}

TEST(VismapClosedForms, TheFloorOfAnOpenCubeSeesItsLid)
{
    // From the floor's centre, and from (nearly) its corner.
    for (const auto& [centre, visibility, near] :
         { std::tuple(V3d(0.5, 0.5, 0), 0.239456, 1e-6), std::tuple(V3d(1e-3, 1e-3, 0), 0.138532, 1e-3) }) {
        const Truth truth = hidden_by_rectangle(V3d(0, 0, 1) - centre, V3d(1, 0, 0), V3d(0, 1, 0));
        EXPECT_NEAR(truth.visibility, visibility, near);
        const V3d x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
        expect_truth(floor_facing_z(kTiny, centre),
                     { rectangle(V3d(0), x, z), rectangle(V3d(0), y, z), rectangle(x, y, z), rectangle(y, x, z) },
                     truth);
    }
}
