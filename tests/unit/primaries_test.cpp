// SPDX-License-Identifier: Apache-2.0
// The known linear spaces: their matrices against published ones and against OpenColorIO's.
#include "color_case.h"

#include <vmlight/image/primaries.h>

#include <OpenImageIO/color.h>

using namespace color_case;

namespace {

void expect_matrix(const char* from, const char* to, const std::array<double, 9>& expected, double tolerance)
{
    const std::array<double, 9> m = matrix_between(*linear_space_named(from), *linear_space_named(to));
    for (size_t i = 0; i < 9; ++i)
        EXPECT_NEAR(m[i], expected[i], tolerance) << from << " to " << to << ", element " << i;
}

} // namespace

TEST(Primaries, MatricesAreThePublishedOnes)
{
    // Bruce Lindbloom; CSS Color 4; ITU-R BT.2087; S-2014-004.
    expect_matrix(
        "lin_ciexyzd65_scene", "lin_rec709_scene",
        { 3.2404542, -1.5371385, -0.4985314, -0.9692660, 1.8760108, 0.0415560, 0.0556434, -0.2040259, 1.0572252 },
        2e-3);
    expect_matrix("lin_p3d65_scene", "lin_rec709_scene",
                  { 1.2249402, -0.2249402, 0, -0.0420570, 1.0420570, 0, -0.0196376, -0.0786361, 1.0982736 }, 1e-5);
    expect_matrix(
        "lin_rec2020_scene", "lin_rec709_scene",
        { 1.6604910, -0.5876411, -0.0728499, -0.1245505, 1.1328999, -0.0083494, -0.0181508, -0.1005789, 1.1187297 },
        1e-5);
    expect_matrix("lin_ap0_scene", "lin_ap1_scene",
                  { 1.4514393161, -0.2365107469, -0.2149285693, -0.0765537734, 1.1762296998, -0.0996759264,
                    0.0083161484, -0.0060324498, 0.9977163014 },
                  1e-5);
}

TEST(Primaries, WhiteStaysWhiteAndThereAndBackIsNothing)
{
    for (const LinearSpace& from : linear_spaces())
        for (const LinearSpace& to : linear_spaces()) {
            const auto there = matrix_between(from, to), back = matrix_between(to, from);
            for (size_t i = 0; i < 3; ++i) {
                const bool numbers_of_light = from.chromaticities[0] == 1 || to.chromaticities[0] == 1; // XYZ
                if (!numbers_of_light) {
                    EXPECT_NEAR(there[3 * i] + there[3 * i + 1] + there[3 * i + 2], 1, 1e-12);
                }
                for (size_t j = 0; j < 3; ++j) {
                    double product = 0;
                    for (size_t k = 0; k < 3; ++k)
                        product += back[3 * i + k] * there[3 * k + j];
                    EXPECT_NEAR(product, i == j ? 1 : 0, 1e-12) << from.interop_id << " " << to.interop_id;
                }
            }
        }
}

TEST(Primaries, OpenColorIoHasTheSameMatrices)
{
    OIIO::ColorConfig config(kConfig);
    for (const char* from : { "lin_ap0_scene", "lin_ap1_scene", "lin_rec709_scene" })
        for (const char* to : { "lin_ap0_scene", "lin_ap1_scene", "lin_rec709_scene" }) {
            const auto m = matrix_between(*linear_space_named(from), *linear_space_named(to));
            const auto processor = config.createColorProcessor(from, to);
            ASSERT_TRUE(processor);
            for (size_t c = 0; c < 3; ++c) {
                float rgb[3] = { 0, 0, 0 };
                rgb[c] = 1;
                processor->apply(rgb, 1, 1, 3, sizeof(float), sizeof(rgb), sizeof(rgb));
                for (size_t i = 0; i < 3; ++i)
                    EXPECT_NEAR(m[3 * i + c], rgb[i], 1e-5) << from << " " << to;
            }
        }
}

TEST(Primaries, SpacesAreKnownByRoundedChromaticities)
{
    const auto id = [](const std::array<float, 8>& xy) {
        const LinearSpace* space = linear_space_with(xy);
        return std::string(space ? space->interop_id : "none");
    };
    EXPECT_EQ(id({ 0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f }), "lin_rec709_scene");
    EXPECT_EQ(id({ 0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.313f, 0.329f }), "lin_rec709_scene");
    EXPECT_EQ(id({ 0.68f, 0.32f, 0.265f, 0.69f, 0.15f, 0.06f, 0.3127f, 0.329f }), "lin_p3d65_scene");
    EXPECT_EQ(id({ 0.68f, 0.32f, 0.265f, 0.69f, 0.15f, 0.06f, 0.314f, 0.351f }), "none"); // DCI white
    EXPECT_EQ(id({ 0.708f, 0.292f, 0.17f, 0.797f, 0.131f, 0.046f, 0.3127f, 0.329f }), "lin_rec2020_scene");
    EXPECT_EQ(id({ 0.7347f, 0.2653f, 0, 1, 0.0001f, -0.077f, 0.32168f, 0.33767f }), "lin_ap0_scene");
    EXPECT_EQ(id({ 0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.322f, 0.338f }), "lin_ap1_scene");
    EXPECT_EQ(id({ 1, 0, 0, 1, 0, 0, 1 / 3.0f, 1 / 3.0f }), "lin_ciexyzd65_scene");
    EXPECT_EQ(id({ 0.64f, 0.33f, 0.21f, 0.71f, 0.15f, 0.06f, 0.3127f, 0.329f }), "none"); // Adobe RGB
    EXPECT_EQ(id({}), "none");
    EXPECT_EQ(linear_space_named("aces - acescg")->interop_id, std::string("lin_ap1_scene"));
    EXPECT_EQ(linear_space_named("ACEScct"), nullptr);
}
