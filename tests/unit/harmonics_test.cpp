// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cfem/spherical_harmonics.h>
#include <vmlight/lightmap/model_sh.h>
#include <vmlight/math/harmonics.h>
#include <vmlight/math/latlong.h>

#include <gtest/gtest.h>

#include <array>
#include <random>

using namespace vmlight;
using Imath::V3d;

namespace {

constexpr int kOrder = Harmonics::kLargestOrder;

// Y_lm of one direction.
std::vector<double> harmonics_at(const V3d& w, int order = kOrder)
{
    std::array<float, Harmonics::kLanes> x, y, z;
    x.fill(float(w.x)), y.fill(float(w.y)), z.fill(float(w.z));
    const Harmonics harmonics(order);
    std::vector<float> values(size_t(harmonics.count()) * Harmonics::kLanes);
    harmonics.evaluate(x.data(), y.data(), z.data(), values.data());
    std::vector<double> result;
    for (int k = 0; k < harmonics.count(); ++k)
        result.push_back(double(values[size_t(k * Harmonics::kLanes + 5)]));
    return result;
}

V3d random_unit_vector(std::mt19937& random)
{
    std::normal_distribution<double> normal;
    return V3d(normal(random), normal(random), normal(random)).normalized();
}

std::vector<double> random_coefficients(int order)
{
    std::mt19937 random(4);
    std::normal_distribution<double> normal;
    std::vector<double> coefficients(size_t(3 * order * order));
    for (double& c : coefficients)
        c = normal(random);
    return coefficients;
}

double sum_at(const std::vector<double>& coefficients, const std::vector<double>& y, int channel)
{
    double sum = 0;
    for (size_t k = 0; k < y.size(); ++k)
        sum += coefficients[3 * k + size_t(channel)] * y[k];
    return sum;
}

} // namespace

TEST(Harmonics, AreThoseOfTheProjection)
{
    const std::vector<double> coefficients = random_coefficients(kOrder);
    std::vector<double> map;
    evaluate_harmonics(map, { 32, 16 }, coefficients, kOrder, 1);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x) {
            const std::vector<double> values = harmonics_at(latlong::direction((x + 0.5) / 32, (y + 0.5) / 16));
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(sum_at(coefficients, values, c), map[size_t(3 * (32 * y + x) + c)], 3e-5);
        }
}

TEST(Harmonics, FulfilTheAdditionTheorem)
{
    // The squares of a band sum to (2 l + 1) / (4 pi), poles included.
    std::mt19937 random(5);
    for (int i = 0; i < 50; ++i) {
        const V3d w = i == 0 ? V3d(0, 1, 0) : i == 1 ? V3d(0, -1, 0) : random_unit_vector(random);
        const std::vector<double> y = harmonics_at(w);
        for (int l = 0; l < kOrder; ++l) {
            double sum = 0;
            for (int k = l * l; k < (l + 1) * (l + 1); ++k)
                sum += y[size_t(k)] * y[size_t(k)];
            EXPECT_NEAR(sum, (2 * l + 1) / (4 * latlong::pi), 4e-6) << l; // rounding of float
        }
    }
}

TEST(Harmonics, TurnWithTheirFunction)
{
    std::mt19937 random(6);
    for (int order = 1; order <= kOrder; ++order) {
        const std::vector<double> coefficients = random_coefficients(order);
        const Rotation turn = rotation_from_angles(20, -75, 130);
        const std::vector<double> turned = rotate_harmonics(coefficients, order, turn);
        for (int i = 0; i < 20; ++i) {
            const V3d w = random_unit_vector(random);
            const std::vector<double> here = harmonics_at(w, order), there = harmonics_at(rotate(turn, w), order);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(sum_at(turned, here, c), sum_at(coefficients, there, c), 2e-5) << order;
        }
        const std::vector<double> back = rotate_harmonics(turned, order, turn.transposed());
        for (size_t k = 0; k < back.size(); ++k)
            EXPECT_NEAR(back[k], coefficients[k], 1e-5);
    }
}
