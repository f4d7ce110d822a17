// SPDX-License-Identifier: Apache-2.0
// Strands that block the light of meshes, and of other strands.
#include "bounced_map.h"
#include "scenes.h"
#include "strand_bake.h"
#include "strand_occluders.h"

#include <vmlight/math/latlong.h>
#include <vmlight/mesh/strand_curve.h>
#include <vmlight/vismap/pose_sequence.h>

#include <OpenImageIO/imagebuf.h>

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

using namespace vmlight;
using namespace vmlight::strand_files;
using namespace vmlight::strand_occluders;
using strand_bake::rays;
using strand_bake::strand_map;

namespace {

OIIO::ImageBuf baked(const Mesh& mesh, const std::vector<Mesh>& occluders, int texels, int samples)
{
    VismapParams params = rays(samples);
    params.resolution = { texels, texels };
    OIIO::ImageBuf map;
    EXPECT_TRUE(make_vismap(map, mesh, occluders, params)) << map.geterror();
    return map;
}

/// Strands that wave above the square [-1, 1], nowhere within 5 radii of it.
Strands meadow(double wave)
{
    Strands strands;
    strands.name = strands.path = "meadow";
    for (uint32_t s = 0; s < 240; ++s) {
        const Point32 at = texel_hash(s, 1, 2), lean = texel_hash(s, 3, 4);
        const V3d root(at.u * 0x1p-31 - 1, at.v * 0x1p-31 - 1, .08);
        const V3d tip(lean.u * 0x1p-31 - 1, lean.v * 0x1p-31 - 1, 1.5);
        for (int p = 0; p < 6; ++p) {
            strands.points.push_back(root + tip * (.2 * p * .5) + V3d(wave * std::sin(2.0 * p), 0, 0));
            strands.radii.push_back(.003 - .0003 * p);
        }
        strands.ends.push_back(uint32_t(strands.points.size()));
    }
    return strands;
}

/// Twelve-sided tubes along the same curves, as wide on average, seen from all sides.
Mesh tubes_of(const Strands& strands)
{
    constexpr int kSides = 12, kRings = 40;
    const double wider = latlong::pi / (kSides * std::sin(latlong::pi / kSides));
    Mesh mesh;
    mesh.name = "tubes";
    for (size_t s = 0; s < strands.count(); ++s) {
        const StrandCurve curve(strands, s);
        const auto first = uint32_t(mesh.positions.size());
        for (int ring = 0; ring <= kRings; ++ring) {
            const CurvePoint at = curve.at(double(ring) / kRings);
            const V3d across = at.tangent.cross(V3d(1, 0, 0)).normalized(), other = at.tangent.cross(across);
            for (int side = 0; side < kSides; ++side) {
                const double angle = 2 * latlong::pi * side / kSides;
                const double reach = at.radius * wider;
                mesh.positions.push_back(at.position + (across * std::cos(angle) + other * std::sin(angle)) * reach);
                mesh.normals.emplace_back(0, 0, 1);
            }
        }
        for (uint32_t ring = 0; ring < kRings; ++ring)
            for (uint32_t side = 0; side < kSides; ++side) {
                const uint32_t a = first + ring * kSides + side, b = first + ring * kSides + (side + 1) % kSides;
                mesh.triangles.push_back({ a, b, b + kSides });
                mesh.triangles.push_back({ a, b + kSides, a + kSides });
            }
    }
    return mesh;
}

} // namespace

TEST(StrandOccluder, ACylinderOverASurfaceHidesItsShareOfTheSky)
{
    // V = 1 - r/h; B loses (4 / 3 pi) (a + sin a cos a), a the half angle that the cylinder fills.
    for (const double h : { .06, .1, .5 }) {
        const double radius = .02, a = std::asin(radius / h);
        const Mesh speck = scenes::floor_facing_z(1e-4);
        const OIIO::ImageBuf map = baked(speck, { occluder_of(cylinder(radius, h)) }, 4, 16384);
        EXPECT_NEAR(map.getchannel(1, 1, 0, 0), 1 - radius / h, .002) << h;
        EXPECT_NEAR(map.getchannel(1, 1, 0, 3), 2.0 / 3 - 4 / (3 * latlong::pi) * (a + std::sin(a) * std::cos(a)), .002)
            << h;
        EXPECT_NEAR(map.getchannel(1, 1, 0, 1), 0, .002) << h;
        EXPECT_NEAR(map.getchannel(1, 1, 0, 2), 0, .002) << h;
    }
}

TEST(StrandOccluder, ShadesAsTubesOfTrianglesDo)
{
    const Mesh floor = scenes::floor_facing_z(1);
    for (const double wave : { 0.0, .05 }) {
        const Strands strands = meadow(wave);
        const OIIO::ImageBuf curves = baked(floor, { occluder_of(strands) }, 32, 1024),
                             tubes = baked(floor, { tubes_of(strands) }, 32, 1024);
        double squares = 0, hidden = 0, difference = 0;
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 32; ++x) {
                const double d = double(curves.getchannel(x, y, 0, 0)) - double(tubes.getchannel(x, y, 0, 0));
                squares += d * d / 1024;
                difference += d / 1024;
                hidden += (1 - double(tubes.getchannel(x, y, 0, 0))) / 1024;
            }
        EXPECT_GT(hidden, .1) << wave;
        // Tubes are open below: their end adds pi r / 2 of their length, .5 %.
        EXPECT_LT(std::abs(difference), .01 * hidden) << wave << " of " << hidden;
        EXPECT_LT(std::sqrt(squares), .005) << wave;
    }
}

TEST(StrandOccluder, HidesFromStrandsWhatTheirOwnFileWouldHide)
{
    const Strands alone = straight({ { V3d(0, 0, -1), V3d(0, 0, 1) } }, .02, 65);
    const Strands beside = straight({ { V3d(.1, 0, -1e3), V3d(.1, 0, 1e3) } }, .02, 65);
    const OIIO::ImageBuf map = strand_map(alone, { occluder_of(beside) }, rays(16384), 9);
    EXPECT_NEAR(map.getchannel(4, 0, 0, 0), 1 - std::asin(.2) / latlong::pi, .002);
    // A strand of another file is no one's own, whatever its number.
    const Strands same = straight({ { V3d(0, 0, -1), V3d(0, 0, 1) } }, .1, 4);
    EXPECT_LT(strand_map(alone, { occluder_of(same) }, rays(64), 9).getchannel(4, 0, 0, 0), .2);
}

TEST(StrandOccluder, SendsNoBouncedLight)
{
    // Half of the sky of a speck is hidden by a strand beside it.
    const Strands wide = straight({ { V3d(-10, 0, .5), V3d(10, 0, .5) } }, .2, 65);
    const scenes::Bounced lit(scenes::floor_facing_z(.5), { occluder_of(wide) }, scenes::bounce_map_of(8));
    EXPECT_LT(lit.visibility[36], .8f);
    const auto gathered = lit.gather(1, [](const LightPoint&) { return 1.f; });
    ASSERT_EQ(gathered.size(), 3 * lit.visibility.size());
    for (const float light : gathered)
        EXPECT_EQ(light, 0);
}

TEST(StrandOccluder, PosesWithStrandsAreBakedWhole)
{
    PoseSequence sequence(.02);
    VismapParams params = rays(16);
    params.resolution = { 16, 16 };
    for (const double z : { .5, .6 }) {
        auto scene = std::make_shared<BakeScene>();
        std::string error;
        OIIO::ImageBuf map;
        VismapReport report;
        ASSERT_TRUE(scene->build(std::make_shared<Mesh>(scenes::floor_facing_z(1)), { occluder_of(cylinder(.02, z)) },
                                 1, error))
            << error;
        ASSERT_TRUE(sequence.bake(map, MapJob { scene, params, 1, {}, 0, nullptr, {} }, z > .5 ? "b" : "a", &report));
        const OIIO::ImageBuf whole = baked(scenes::floor_facing_z(1), { occluder_of(cylinder(.02, z)) }, 16, 16);
        EXPECT_EQ(std::memcmp(map.localpixels(), whole.localpixels(), size_t(map.spec().image_bytes())), 0);
    }
    EXPECT_EQ(sequence.last().kept, 0);
    EXPECT_THAT(sequence.last().why, testing::HasSubstr("strands among the occluders are not compared"));
}
