// SPDX-License-Identifier: Apache-2.0
// Reconstruction over the seams between islands, and with what else a scene has: ground, cut-outs, UDIM tiles.
#include "closed_forms.h"
#include "cutout_scene.h"
#include "error_scenes.h"

#include <vmlight/base/available_memory.h>
#include <vmlight/vismap/reconstruct.h>
#include <vmlight/vismap/seam_links.h>

#include <cstring>
#include <string>
#include <vector>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

constexpr int kSeamSide = 96;

// A floor of 2 x 2 that faces +z, in halves that meet at x = 0: the left one upright in the map, the right one turned
// by a quarter, elsewhere in the map. The right one rises from the seam by `slope`. Unless `meets`, they are not of one
// surface by a hair.
Mesh halves(double slope = 0, bool meets = true, float right_tile = 0)
{
    Mesh mesh;
    const double hair = meets ? 0 : 1e-30;
    const V3f up(0, 0, 1), right_up = V3f(float(-slope), 0, 1).normalized();
    const auto add = [&](V3d p, V3f normal, V2f uv) {
        mesh.positions.push_back(p), mesh.normals.push_back(normal), mesh.uvs.push_back(uv);
    };
    add(V3d(-1, -1, 0), up, V2f(0.05f, 0.05f));
    add(V3d(0, -1, 0), up, V2f(0.3f, 0.05f));
    add(V3d(0, 1, 0), up, V2f(0.3f, 0.55f));
    add(V3d(-1, 1, 0), up, V2f(0.05f, 0.55f));
    add(V3d(hair, -1, 0), right_up, V2f(right_tile + 0.95f, 0.65f));
    add(V3d(1, -1, slope), right_up, V2f(right_tile + 0.95f, 0.9f));
    add(V3d(1, 1, slope), right_up, V2f(right_tile + 0.45f, 0.9f));
    add(V3d(hair, 1, 0), right_up, V2f(right_tile + 0.45f, 0.65f));
    mesh.triangles = { { 0, 1, 2 }, { 0, 2, 3 }, { 4, 5, 6 }, { 4, 6, 7 } };
    mesh.triangle_materials.assign(4, 0);
    return mesh;
}

bool have_same_bytes(const OIIO::ImageBuf& a, const OIIO::ImageBuf& b)
{
    return a.spec().image_bytes() == b.spec().image_bytes()
        && std::memcmp(a.localpixels(), b.localpixels(), size_t(a.spec().image_bytes())) == 0;
}

} // namespace

TEST(ReconstructSeams, ACellBeyondASeamIsWhereTheSurfaceGoesOn)
{
    const Mesh mesh = halves();
    const UvRaster raster(mesh, kSeamSide, kSeamSide);
    const SeamLinks seams(mesh, raster, kSeamSide, kSeamSide, kFirstUdim);
    EXPECT_EQ(seams.links(), 2u);
    std::vector<SeamCell> cells;
    int found = 0;
    for (int tile = 0; tile < 4; ++tile) {
        const int x = tile % 2 * kTileSize, y = tile / 2 * kTileSize;
        seams.find({ x, std::min(x + kTileSize, kSeamSide), y, std::min(y + kTileSize, kSeamSide) }, cells);
        for (const SeamCell& cell : cells) {
            if (cell.island != seams.island(0))
                continue;
            // The halves' maps from texels to the floor; a texel of the right one is the nearest, half a texel away.
            const double u = (cell.x + 0.5) / kSeamSide, v = 1 - (cell.y + 0.5) / kSeamSide;
            const V3d there((u - 0.3) / 0.25, (v - 0.05) / 0.25 - 1, 0);
            const double s = (cell.source_x + 0.5) / kSeamSide, t = 1 - (cell.source_y + 0.5) / kSeamSide;
            const V3d source((t - 0.65) / 0.25, (0.95 - s) / 0.25 - 1, 0);
            EXPECT_GT(there.x, 0);
            EXPECT_LE(std::abs(there.x - source.x), 0.51 / kSeamSide / 0.25);
            EXPECT_LE(std::abs(there.y - source.y), 0.51 / kSeamSide / 0.25);
            ++found;
        }
    }
    EXPECT_GT(found, 4 * 40);
}

TEST(ReconstructSeams, TexelsBesideASeamGainAsMuchAsOthers)
{
    const std::vector<Mesh> ball { sphere(V3d(0.2, 0.1, 0.7), 0.4, 24) };
    for (const int samples : { 16, 64 }) {
        VismapParams truth = reconstruct_params(kSeamSide, 64 * samples);
        truth.reconstruct = "off";
        truth.seed = 77;
        const BakedMap reference(halves(), ball, truth);
        const BakedMap linked(halves(), ball, reconstruct_params(kSeamSide, samples)),
            apart(halves(0, false), ball, reconstruct_params(kSeamSide, samples));
        const auto error_beside = [&](const BakedMap& map) {
            double squares = 0;
            map.each([&](const Texel& t, int x, int y) {
                if (const double u = (x + 0.5) / kSeamSide; u > 0.3 - 3.0 / kSeamSide && u < 0.3)
                    squares += std::pow(double(t.visibility) - double(reference.at(x, y).visibility), 2);
            });
            return std::sqrt(squares);
        };
        EXPECT_LT(error_beside(linked), 0.9 * error_beside(apart)) << samples;
        EXPECT_LT(true_rms(linked, reference), true_rms(apart, reference)) << samples;
    }
}

TEST(ReconstructSeams, NothingPassesOverACrease)
{
    const std::vector<Mesh> ball { sphere(V3d(-0.2, 0.1, 0.7), 0.4, 24) };
    for (const double slope : { 1.0, 4.0, -1.0 }) {
        const BakedMap linked(halves(slope), ball, reconstruct_params(kSeamSide, 16));
        EXPECT_TRUE(have_same_bytes(linked.image(),
                                    BakedMap(halves(slope, false), ball, reconstruct_params(kSeamSide, 16)).image()));
    }
    EXPECT_FALSE(have_same_bytes(BakedMap(halves(), ball, reconstruct_params(kSeamSide, 16)).image(),
                                 BakedMap(halves(0, false), ball, reconstruct_params(kSeamSide, 16)).image()));
}

TEST(ReconstructSeams, AnotherUdimTileChangesNoByte)
{
    const std::vector<Mesh> ball { sphere(V3d(0.2, 0.1, 0.7), 0.4, 24) };
    const BakedMap next(halves(0, true, 1), ball, reconstruct_params(kSeamSide, 16)),
        far(halves(0, true, 4), ball, reconstruct_params(kSeamSide, 16));
    EXPECT_TRUE(have_same_bytes(next.image(), far.image()));
    VismapParams second = reconstruct_params(kSeamSide, 16);
    second.udim = kFirstUdim + 1;
    EXPECT_TRUE(have_same_bytes(BakedMap(halves(0, true, 1), ball, second).image(),
                                BakedMap(halves(0, false, 1), ball, second).image()));
}

TEST(ReconstructSeams, TheSameBytesForAnyThreads)
{
    const std::vector<Mesh> ball { sphere(V3d(0.2, 0.1, 0.7), 0.4, 24) };
    EXPECT_TRUE(have_same_bytes(BakedMap(halves(), ball, reconstruct_params(kSeamSide, 16), 1).image(),
                                BakedMap(halves(), ball, reconstruct_params(kSeamSide, 16), 5).image()));
}

TEST(ReconstructSeams, AWallOverTheGroundStaysExact)
{
    VismapParams params = map_params(64, 64, 16);
    params.ground = true;
    params.ground_height = -1;
    VismapParams with = params;
    with.reconstruct = "auto";
    const Mesh wall = floor_facing_z(1); // upright, as y is up
    const BakedMap plain(wall, {}, params), map(wall, {}, with);
    map.each([&](const Texel& t, int x, int y) {
        ASSERT_EQ(t, plain.at(x, y)) << x << " " << y;
        ASSERT_NEAR(t.visibility, 0.5, 1e-6); // all below the horizon, from any height
    });
}

TEST(ReconstructSeams, AHalfTransparentCardLetsHalfPass)
{
    const Mesh card = cutout_scene::with_material(cutout_scene::card(closed_forms::kFar, 1),
                                                  cutout_scene::material(AlphaMode::blend, nullptr, 0.5));
    for (const int samples : { 16, 64 }) {
        VismapParams plain = map_params(64, 64, samples), with = plain;
        with.reconstruct = "auto";
        const Truth truth { 0.5, V3d(0, 0, 1.0 / 3) };
        const MapError before = error_of(BakedMap(floor_facing_z(1), { card }, plain), truth);
        const MapError after = error_of(BakedMap(floor_facing_z(1), { card }, with), truth);
        EXPECT_LE(after.visibility, before.visibility / 2 + 1e-6) << samples;
        EXPECT_LE(after.direction, before.direction / 2 + 1e-6) << samples;
    }
}

TEST(ReconstructSeams, ItsProgressGrowsToOneAndStopsIt)
{
    const BakeInput scene = spot_on_the_ground();
    const VismapParams params = reconstruct_params(kSeamSide, 4);
    double last = 0;
    OIIO::ImageBuf map;
    const auto grows = [&](double done) {
        EXPECT_GE(done, last);
        last = done;
        return true;
    };
    ASSERT_TRUE(make_vismap(map, scene.mesh, scene.occluders, params, nullptr, 1, grows)) << map.geterror();
    EXPECT_EQ(last, 1);
    // In the last part, when all is baked: no tile more, and no map.
    int after = 0;
    OIIO::ImageBuf stopped;
    const auto stops = [&](double done) {
        after += done > 0.951;
        return done < 0.951;
    };
    EXPECT_FALSE(make_vismap(stopped, scene.mesh, scene.occluders, params, nullptr, 1, stops));
    EXPECT_EQ(stopped.geterror(), "interrupted");
    EXPECT_EQ(after, 1);
}

TEST(ReconstructSeams, ItsMemoryCountsWhenAJobIsRefused)
{
    VismapParams params = map_params(4096, 1024, 16);
    EXPECT_EQ(reconstruct_bytes(params), 0);
    params.reconstruct = "auto";
    EXPECT_EQ(reconstruct_bytes(params), 4096.0 * 1024 * (5 * sizeof(float) + sizeof(TexelContext)));
    const OIIO::ImageSpec small(4, 4, 1, OIIO::TypeDesc::FLOAT);
    EXPECT_EQ(memory_shortage(small), "");
    EXPECT_NE(memory_shortage(small, 1e18).find("of memory"), std::string::npos);
}
