// SPDX-License-Identifier: Apache-2.0
/// Bakes against visibility that is known in closed form. Each scene is seen from 64 texels in (nearly) one place, each
/// with its own scramble: 64 seeds at once.
#pragma once

#include "baked_map.h"
#include "scenes.h"

#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace vmlight::closed_forms {

using namespace scenes;

inline const double kPi = M_PI;
inline const double kFar = 1e5;
inline const double kTiny = 1e-4; // half the side of the baked floor

/// Root mean square error of V and of B (length of the error) is at most c N^-0.75 for N = 16 to 4096, measured over
/// 1024 seeds on the scenes wall, corner, strip, disc, pit and sphere; c is that of the worst scene,
/// and 10 % more. `fibonacci` on the sphere, where all samplers do worst, measured (N: V, B):
///     16: .0517 .0531   64: .0171 .0173   256: .0055 .0057   1024: .0017 .0017   4096: .0008 .0008
/// `sobol`:
///     16: .0565 .0663   64: .0194 .0203   256: .0071 .0070   1024: .0025 .0026   4096: .0008 .0009
/// `halton`:
///     16: .0588 .0666   64: .0222 .0253   256: .0078 .0081   1024: .0030 .0031   4096: .0011 .0011
/// On walls parallel to a sampler's strata V is far better (Sobol: exact).
struct Rate
{
    const char* sampler;
    double visibility, direction, uniform_visibility, uniform_direction;
};
inline const Rate kRates[] = { { "fibonacci", 0.47, 0.48, 0.50, 0.80 },
                               { "sobol", 0.53, 0.60, 0.54, 0.95 },
                               { "halton", 0.61, 0.65, 0.58, 0.95 } };

inline double bound(double c, int samples)
{
    return c * std::pow(samples, -0.75);
}

inline BakeScenePointer shared_scene(const Mesh& floor, const std::vector<Mesh>& occluders)
{
    const auto scene = std::make_shared<BakeScene>();
    std::string error;
    EXPECT_TRUE(scene->build(std::make_shared<const Mesh>(floor), occluders, 0, error)) << error;
    return scene;
}

/// The map may err by what the sampler does: 1.4 times the bound over 64 texels (4 sigma of a root mean square of 64
/// normal numbers is 1.35), 5 / sqrt(64) of it in the mean; and by `flaw`, which the scene's facets add.
inline void expect_truth(const Mesh& floor, const std::vector<Mesh>& occluders, const Truth& truth, double flaw = 2e-4)
{
    const BakeScenePointer scene = shared_scene(floor, occluders);
    for (const Rate& rate : kRates)
        for (int samples : { 16, 64, 256, 1024, 2048 })
            for (const char* measure : { "cosine", "uniform" }) {
                const bool uniform = measure[0] == 'u';
                if (uniform && (truth.uniform_visibility < 0 || samples > 256))
                    continue;
                VismapParams params = map_params(8, 8, samples, rate.sampler);
                params.measure = measure;
                params.seed = samples;
                Truth wanted = truth;
                if (uniform)
                    wanted
                        = { truth.uniform_visibility, truth.direction * (truth.uniform_visibility / truth.visibility) };
                const MapError error = error_of(BakedMap(scene, params), wanted);
                const double v = bound(uniform ? rate.uniform_visibility : rate.visibility, samples);
                const double d = bound(uniform ? rate.uniform_direction : rate.direction, samples);
                SCOPED_TRACE(testing::Message() << rate.sampler << ", " << samples << " rays, " << measure);
                EXPECT_LE(error.visibility, 1.4 * v + flaw);
                EXPECT_LE(error.direction, 1.4 * d + flaw);
                EXPECT_LE(std::abs(error.visibility_bias), 5.0 / 8 * v + flaw);
                // With the mean over shifts, B / V of few rays is not the mean of B: `uniform` divides by a sum.
                EXPECT_LE(error.direction_bias, (uniform ? 1.0 : 5.0 / 8) * d + flaw);
            }
}

inline void expect_truth(const std::vector<Mesh>& occluders, const Truth& truth, double flaw = 2e-4)
{
    expect_truth(floor_facing_z(kTiny), occluders, truth, flaw);
}

/// What a rectangle hides from the origin of the upper half space, by midpoint quadrature of its two integrals.
inline Truth hidden_by_rectangle(V3d corner, V3d side1, V3d side2)
{
    const int n = 600;
    const V3d cross = side1.cross(side2);
    Truth hidden { 0, V3d(0) };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const V3d p = corner + side1 * ((i + 0.5) / n) + side2 * ((j + 0.5) / n);
            const double r = p.length();
            const V3d w = p / r;
            const double solid_angle = std::abs(w.dot(cross)) / (r * r * n * n);
            hidden.visibility += w.z * solid_angle / kPi;
            hidden.direction += w * (w.z * solid_angle / kPi);
        }
    return hidden;
}

inline Truth without(const Truth& hidden)
{
    return { 1 - hidden.visibility, V3d(0, 0, 2.0 / 3) - hidden.direction };
}

inline Mesh wall_at_minus_x(double x)
{
    return rectangle(V3d(x, -kFar, 0), V3d(0, 2 * kFar, 0), V3d(0, 0, kFar));
}

inline Mesh wall_at_minus_y(double y)
{
    return rectangle(V3d(-kFar, y, 0), V3d(2 * kFar, 0, 0), V3d(0, 0, kFar));
}

// Turned about z by an angle that no sampler knows.
inline Mesh turned(Mesh mesh, double angle)
{
    for (V3d& p : mesh.positions)
        p = V3d(std::cos(angle) * p.x - std::sin(angle) * p.y, std::sin(angle) * p.x + std::cos(angle) * p.y, p.z);
    return mesh;
}

inline V3d turned(V3d p, double angle)
{
    return V3d(std::cos(angle) * p.x - std::sin(angle) * p.y, std::sin(angle) * p.x + std::cos(angle) * p.y, p.z);
}

} // namespace vmlight::closed_forms
