// SPDX-License-Identifier: Apache-2.0
// Bounced light of maps that are more than a plain surface on one tile.
#include "bounced_map.h"
#include "cutout_scene.h"

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

// A white wall beside the floor of corner(), without uvs.
Mesh white_wall()
{
    return rectangle(V3d(0, -40, 0), V3d(0, 80, 0), V3d(0, 0, 1));
}

// A card between that wall and the floor, in fields of a checker as cutout_scene::checker() has them.
constexpr int kFields = 4;
const V3d kCardCorner(0.2, 2, 0), kCardAlong(0, -4, 0), kCardUp(0, 0, 0.8);

Mesh checker_card()
{
    Mesh card;
    card.name = "card";
    add_quad(card, kCardCorner, kCardCorner + kCardAlong, kCardCorner + kCardAlong + kCardUp, kCardCorner + kCardUp,
             V2f(0, 0), V2f(1, 1));
    return card;
}

Mesh closed_fields()
{
    Mesh fields;
    for (int row = 0; row < kFields; ++row) // from the top, as texels are
        for (int column = row % 2; column < kFields; column += 2) {
            const V3d corner = kCardCorner + kCardAlong * (double(column) / kFields)
                + kCardUp * (double(kFields - 1 - row) / kFields);
            const V3d along = kCardAlong / kFields, up = kCardUp / kFields;
            add_quad(fields, corner, corner + along, corner + along + up, corner + up);
        }
    return fields;
}

// The strip of floor that the card stands on.
Mesh strip()
{
    Mesh mesh;
    add_quad(mesh, V3d(0, -1, 0), V3d(1, -1, 0), V3d(1, 1, 0), V3d(0, 1, 0), V2f(0, 0), V2f(1, 1));
    return mesh;
}

Mesh cut_out(const Mesh& mesh, double factor)
{
    const auto alpha = cutout_scene::texture(
        kFields, kFields, [](int x, int y) { return float((x + y + 1) % 2); }, TextureWrap::clamp, TextureWrap::clamp,
        true);
    return cutout_scene::with_material(mesh, cutout_scene::material(AlphaMode::mask, alpha, factor));
}

// Root mean square, and the mean.
struct Deviation
{
    double rms, bias;
};

// How far the light of a map of corner() is from radiosity in two dimensions, in the middle of the strips: root mean
// square and mean, relative to the mean of all light. `column` is that of the map, from 0 to 1, of a distance from the
// edge.
template <class Column> Deviation error_of_corner(const Bounced& bounced, const Column& column)
{
    const auto [width, height] = bounced.map.size();
    const std::vector<float> light = bounced.gather(1);
    const auto hidden = [](double x) { return 0.5 * (1 - x / std::sqrt(x * x + 1)); };
    double squares = 0, sum = 0, all = 0, count = 0;
    for (int y = height / 2 - 4; y < height / 2 + 4; ++y)
        for (int x = 0; x < width; ++x, ++count) {
            const double at = column((x + 0.5) / width);
            double wanted = 0;
            constexpr int n = 1000;
            for (int i = 0; i < n; ++i) {
                const double h = (i + 0.5) / n;
                wanted += (1 - hidden(h)) * 0.5 * at * h / std::pow(at * at + h * h, 1.5) / n;
            }
            const double error = double(light[3 * size_t(y * width + x)]) - wanted;
            squares += error * error;
            sum += error;
            all += 1 - hidden(at) + wanted;
        }
    return { std::sqrt(squares / count) / (all / count), sum / all };
}

} // namespace

TEST(LightTransportSurfaces, AHolePassesLightThatBounces)
{
    const Bounced bounced(strip(), { white_wall(), cut_out(checker_card(), 1) }, bounce_map_of(32));
    const auto albedo = [](const LightPoint& point) { return point.caster == 0 ? 1.0f : 0.0f; };
    const std::vector<float> light = bounced.gather(0, albedo);
    const oracle::Bounce truth({ strip(), white_wall(), closed_fields() }, constant_sky,
                               [](size_t t) { return t == 2 || t == 3 ? 1.0 : 0.0; });
    const std::vector<oracle::Place> places = oracle::places(strip(), 32, 32);
    EXPECT_LT(error_of(light, places, truth, 19), 0.2); // the wall is lit in fields, by points
    // Not as if it were closed.
    const std::vector<float> shut
        = Bounced(strip(), { white_wall(), checker_card() }, bounce_map_of(32)).gather(0, albedo);
    EXPECT_GT(error_of(shut, places, truth, 19), 0.3);
}

TEST(LightTransportSurfaces, WhatIsTransparentNeitherBlocksNorSendsLight)
{
    const std::vector<float> with
        = Bounced(strip(), { white_wall(), cut_out(checker_card(), 0) }, bounce_map_of(32)).gather(1);
    EXPECT_EQ(with, Bounced(strip(), { white_wall() }, bounce_map_of(32)).gather(1));
}

TEST(LightTransportSurfaces, AMappedNormalSeesItsOwnSurface)
{
    // Leaning away from the wall, half way to the horizon.
    const VismapParams map = bounce_map_of(32);
    const double lean = M_PI / 4;
    OIIO::ImageBuf image(OIIO::ImageSpec(4, 4, 3, OIIO::TypeFloat));
    for (OIIO::ImageBuf::Iterator<float> pixel(image); !pixel.done(); ++pixel) {
        pixel[0] = float(0.5 + 0.5 * std::sin(lean));
        pixel[1] = 0.5f;
        pixel[2] = float(0.5 + 0.5 * std::cos(lean));
    }
    const auto normals = std::make_shared<NormalMap>();
    std::vector<std::string> warnings;
    std::string error;
    ASSERT_TRUE(normals->decode(image, {}, map.size(), 1, warnings, error)) << error;
    normals->attach(std::make_shared<Mesh>(strip()));
    const Bounced bounced(strip(), { white_wall() }, map, {}, 0, normals);
    const double own = 0.6, wall = 0.9;
    const std::vector<float> light = bounced.gather(float(own), [&](const LightPoint&) { return float(wall); });
    oracle::Bounce truth({ strip(), white_wall() }, constant_sky, [&](size_t t) { return t < 2 ? own : wall; });
    const std::vector<oracle::Place> places = oracle::places(strip(), 32, 32);
    const V3d leaning(std::sin(lean), 0, std::cos(lean));
    double squares = 0, all = 0, count = 0;
    for (size_t i = 0; i < places.size(); i += 13, ++count) {
        const auto [sky, wanted] = truth.light_of_mapped(places[i].position, V3d(0, 0, 1), leaning, own, 28, 6);
        ASSERT_NEAR(bounced.visibility[i], sky, 0.02) << i;
        squares += std::pow(double(light[3 * i]) - wanted, 2);
        all += sky + wanted;
    }
    EXPECT_LT(std::sqrt(squares / count), 0.01 * all / count);
    // Far from the wall, where it sees little else.
    EXPECT_GT(light[3 * (16 * 32 + 31)], 0.5 * own * (1 - std::cos(lean)) / 2);
}

TEST(LightTransportSurfaces, AMapOfManyTilesIsLitAsOneOfOne)
{
    // 5 x 5 tiles, of patches of 2 x 2 texels.
    VismapParams map = bounce_map_of(320);
    map.samples = 128;
    const Bounced bounced(corner(), {}, map);
    const Deviation error = error_of_corner(bounced, [](double u) { return u < 0.5 ? 2 * u : 2 * u - 1; });
    EXPECT_LT(error.rms, 0.012);
    EXPECT_LT(std::abs(error.bias), 0.003);
}

TEST(LightTransportSurfaces, AnotherUdimTileLightsThisOne)
{
    // The floor is on one tile, the wall on the next.
    Mesh mesh;
    add_quad(mesh, V3d(0, -40, 0), V3d(1, -40, 0), V3d(1, 40, 0), V3d(0, 40, 0), V2f(0, 0), V2f(1, 1));
    add_quad(mesh, V3d(0, 40, 0), V3d(0, 40, 1), V3d(0, -40, 1), V3d(0, -40, 0), V2f(1, 0), V2f(2, 1));
    for (const int udim : { 1001, 1002 }) {
        VismapParams map = bounce_map_of(64);
        map.udim = udim;
        const Bounced bounced(mesh, {}, map);
        EXPECT_FALSE(bounced.transport.points().empty());
        for (const LightPoint& point : bounced.transport.points()) {
            ASSERT_EQ(point.caster, BakeScene::kWhole);
            ASSERT_EQ(point.triangle / 2, udim == 1001 ? 1u : 0u);
        }
        // uv0 of the wall is its foot: rows of the texture, as those of the floor, run along the edge.
        // What is off the map sends light in cells of 1/128 of the mesh at least, more than half of this wall's height.
        const Deviation error = error_of_corner(bounced, [](double u) { return u; });
        EXPECT_LT(error.rms, 0.03) << udim;
        EXPECT_LT(std::abs(error.bias), 0.01) << udim;
    }
}
