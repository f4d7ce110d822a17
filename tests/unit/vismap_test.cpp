// SPDX-License-Identifier: Apache-2.0
// What a bake takes, counts and refuses. Its texels: vismap_texture_test.cpp; closed forms:
// vismap_closed_forms_test.cpp.
#include "baked_map.h"
#include "scenes.h"

#include <vmlight/mesh/shape.h>

#include <cstring>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

// A floor half under a roof, with a wall: something partly blocked everywhere.
Mesh courtyard()
{
    Mesh mesh = floor_facing_z(1);
    for (V2f& uv : mesh.uvs)
        uv.x *= 0.5f;
    append(mesh, box(V3d(0.1, 0.2, 0.4), V3d(1.5, 0.9, 0.6), false));
    for (size_t v = 4; v < mesh.uvs.size(); ++v)
        mesh.uvs[v].x = 0.5f + 0.5f * mesh.uvs[v].x;
    return mesh;
}

std::string bake_refusal(const Mesh& mesh, const VismapParams& params, const Progress& progress = {})
{
    OIIO::ImageBuf image(OIIO::ImageSpec(3, 3, 1, OIIO::TypeDesc::FLOAT));
    EXPECT_FALSE(make_vismap(image, mesh, {}, params, nullptr, 2, progress));
    EXPECT_EQ(image.spec().width, 0);
    EXPECT_FALSE(image.initialized());
    return image.geterror();
}

} // namespace

TEST(Vismap, AMapSaysWhatItIsAndHowItWasMade)
{
    VismapParams params = map_params(96, 40, 16, "sobol");
    params.margin = 3;
    const Mesh mesh = courtyard();
    const BakedMap map(mesh, { wall_at_x1(), floor_facing_z(1) }, params);
    const OIIO::ImageSpec& spec = map.spec();
    EXPECT_EQ(spec.format, OIIO::TypeDesc::FLOAT);
    EXPECT_EQ(spec.width, 96);
    EXPECT_EQ(spec.height, 40);
    EXPECT_EQ(spec.channelnames,
              (std::vector<std::string> { "visibility", "direction.x", "direction.y", "direction.z", "coverage" }));
    EXPECT_EQ(spec.get_string_attribute("vmlight:stage"), "vismap");
    EXPECT_EQ(spec.get_string_attribute("vmlight:mesh"), "floor");
    EXPECT_EQ(spec.get_string_attribute("vmlight:meshHash"), mesh_hash(mesh));
    EXPECT_EQ(spec.get_string_attribute("vmlight:meshShape"), mesh_shape(mesh));
    EXPECT_EQ(spec.get_string_attribute("vmlight:occluderHash"),
              mesh_hash(wall_at_x1()) + "," + mesh_hash(floor_facing_z(1)));
    EXPECT_EQ(std::string(spec.get_string_attribute("vmlight:occluder")), "quad, floor");
    EXPECT_EQ(spec.get_string_attribute("vmlight:sampler"), "sobol");
    EXPECT_EQ(spec.get_string_attribute("vmlight:samples"), "16");
    EXPECT_EQ(spec.get_string_attribute("vmlight:margin"), "3");
    EXPECT_EQ(spec.get_string_attribute("colorInteropID"), "data");
    EXPECT_EQ(spec.find_attribute("oiio:ColorSpace"), nullptr);
}

TEST(Vismap, WidthAndHeightReplaceTheSidesOfTheResolution)
{
    VismapParams params = map_params(64, 64, 1);
    params.width = 7;
    EXPECT_EQ(BakedMap(floor_facing_z(1), {}, params).spec().width, 7);
    EXPECT_EQ(BakedMap(floor_facing_z(1), {}, params).spec().height, 64);
    params.height = 1;
    EXPECT_EQ(BakedMap(floor_facing_z(1), {}, params).spec().height, 1);
}

TEST(Vismap, AnyNumberOfThreadsGivesTheSameBits)
{
    VismapParams params = map_params(200, 130, 24);
    params.margin = 5;
    for (const char* sampler : { "fibonacci", "sobol", "halton" }) {
        params.sampler = sampler;
        const BakedMap one(courtyard(), { wall_at_x1() }, params, 1);
        for (int threads : { 2, 7, 0 }) {
            const BakedMap map(courtyard(), { wall_at_x1() }, params, threads);
            EXPECT_EQ(std::memcmp(map.image().localpixels(), one.image().localpixels(), map.spec().image_bytes()), 0);
            EXPECT_EQ(map.report.rays, one.report.rays);
            EXPECT_EQ(map.report.covered, one.report.covered);
            EXPECT_EQ(map.report.dark, one.report.dark);
        }
    }
}

TEST(Vismap, TheSeedAloneTurnsTheNoise)
{
    VismapParams params = map_params(64, 64, 16);
    const BakedMap first(courtyard(), {}, params), again(courtyard(), {}, params);
    EXPECT_TRUE(first == again);
    params.seed = 1;
    const BakedMap other(courtyard(), {}, params);
    double changed = 0, texels = 0, mean = 0;
    other.each_covered([&](const Texel& t, int x, int y) {
        const Texel f = first.at(x, y);
        changed += t.visibility != f.visibility;
        texels += f.visibility > 0.1 && f.visibility < 0.9;
        mean += t.visibility - f.visibility;
    });
    EXPECT_GT(changed, 0.5 * texels);
    EXPECT_LT(std::abs(mean), 0.01 * texels);
}

TEST(Vismap, OccludersCastAndAreNotBaked)
{
    Mesh occluder = wall_at_x1();
    occluder.uvs = floor_facing_z(1).uvs; // texture coordinates do not make it a thing to bake
    const BakedMap map(floor_facing_z(1), { occluder }, map_params(16, 16, 256));
    EXPECT_EQ(map.report.covered, 256);
    EXPECT_EQ(map.report.overlapping, 0);
    map.each([](const Texel& t, int, int) {
        EXPECT_NEAR(t.visibility, 0.5, 0.05);
        EXPECT_LT(t.direction.x, -0.15);
    });
}

TEST(Vismap, AnOccluderWithoutTrianglesHidesNothing)
{
    const BakedMap map(floor_facing_z(1), { Mesh(), wall_at_x1() }, map_params(8, 8, 64));
    map.each([](const Texel& t, int, int) { EXPECT_NEAR(t.visibility, 0.5, 0.1); });
    const BakedMap open(floor_facing_z(1), { Mesh() }, map_params(8, 8, 64));
    open.each([](const Texel& t, int, int) { EXPECT_EQ(t.visibility, 1); });
}

TEST(Vismap, BothVisibilityAndDirectionHonourTheGreatestDistance)
{
    // A ceiling at height 1 within reach R hides the cone whose cosine is 1 / R: V = 1 - sin^2 = 1 / R^2, at any scale.
    for (double scale : { 1.0, 1e-6, 1e6 })
        for (double reach : { 0.999, 1.5, 3.0 }) {
            const Mesh ceiling = rectangle(V3d(-1e3, -1e3, 1) * scale, V3d(2e3, 0, 0) * scale, V3d(0, 2e3, 0) * scale);
            VismapParams params = map_params(8, 8, 1024);
            params.max_distance = reach * scale;
            const double c = std::min(1.0, 1 / reach);
            const MapError error
                = error_of(BakedMap(floor_facing_z(1e-3 * scale), { ceiling }, params),
                           { reach < 1 ? 1 : c * c, V3d(0, 0, 2.0 / 3 * (reach < 1 ? 1 : c * c * c)) });
            EXPECT_LT(error.visibility, reach < 1 ? 1e-9 : 0.004) << reach << ", " << scale;
            EXPECT_LT(error.direction, reach < 1 ? 1e-6 : 0.004) << reach << ", " << scale;
        }
}

TEST(Vismap, NormalsAreThoseOfTheSurface)
{
    const Mesh mesh = sphere(V3d(3, -2, 5), 2, 32);
    VismapParams params = map_params(128, 64, 16);
    params.channels = { "normal" };
    params.margin = 2;
    OIIO::ImageBuf plain, image;
    ASSERT_TRUE(make_vismap(image, mesh, {}, params)) << image.geterror();
    EXPECT_EQ(image.spec().channelnames,
              (std::vector<std::string> { "visibility", "direction.x", "direction.y", "direction.z", "normal.x",
                                          "normal.y", "normal.z" }));
    EXPECT_EQ(image.spec().get_string_attribute("vmlight:channels"), "normal");
    int covered = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 128; ++x) {
            float t[7];
            image.getpixel(x, y, t);
            const V3f b(t[1], t[2], t[3]), n(t[4], t[5], t[6]);
            if (t[0] < 1)
                continue; // the background; a ball sees all of its hemispheres
            ++covered;
            EXPECT_NEAR(n.length(), 1, 1e-2); // in the margin a mean
            EXPECT_GT(n.dot(b), 0.66f);
        }
    EXPECT_GT(covered, 1000);
    params.channels.clear();
    ASSERT_TRUE(make_vismap(plain, mesh, {}, params)) << plain.geterror();
    for (int i = 0; i < 128 * 64; ++i)
        for (int c = 0; c < 4; ++c)
            ASSERT_EQ(plain.getchannel(i % 128, i / 128, 0, c), image.getchannel(i % 128, i / 128, 0, c));
}

TEST(Vismap, ChannelsAreTheSameInWhateverOrderTheyAreAskedFor)
{
    const Mesh mesh = floor_facing_z(1);
    VismapParams params = map_params(8, 8, 4);
    params.channels = { "normal", "coverage" };
    const BakedMap one(mesh, {}, params);
    params.channels = { "coverage", "normal" };
    const BakedMap other(mesh, {}, params);
    EXPECT_EQ(one.spec().to_xml(), other.spec().to_xml());
    EXPECT_EQ(one.spec().get_string_attribute("vmlight:channels"), "normal,coverage");
    float a[8], b[8];
    one.image().getpixel(3, 4, a);
    other.image().getpixel(3, 4, b);
    EXPECT_TRUE(std::equal(a, a + 8, b));
    EXPECT_EQ(a[6], 1); // the normal's z, and the coverage
    EXPECT_EQ(a[7], 1);
}

TEST(Vismap, TheReportCountsTexelsAndRays)
{
    Mesh mesh = floor_facing_z(1);
    for (V2f& uv : mesh.uvs)
        uv.y *= 0.5f;
    append(mesh, box(V3d(-9), V3d(9), true));
    for (size_t v = 4; v < mesh.uvs.size(); ++v)
        mesh.uvs[v] = V2f(NAN, NAN);
    const BakedMap map(mesh, {}, map_params(32, 32, 10));
    EXPECT_EQ(map.report.texels, 1024);
    EXPECT_EQ(map.report.covered, 512);
    EXPECT_EQ(map.report.overlapping, 0);
    EXPECT_EQ(map.report.dark, 512); // closed in
    EXPECT_EQ(map.report.rays, 5120);
}

TEST(Vismap, RefusesWhatItCannotBake)
{
    Mesh mesh = floor_facing_z(1);
    mesh.uvs.clear();
    EXPECT_EQ(bake_refusal(mesh, {}),
              "\"floor\": no texture coordinates in this UV set: choose another uv_set, or unwrap the mesh with "
              "makevismap --unwrap");
    mesh.triangles.clear();
    EXPECT_EQ(bake_refusal(mesh, {}), "\"floor\": no triangles");
}

TEST(Vismap, RefusesParametersOutOfRange)
{
    const Mesh mesh = floor_facing_z(1);
    VismapParams params;
    params.samples = 0;
    EXPECT_EQ(bake_refusal(mesh, params), "samples: 0 is not in [1, 1048576]");
    params = {};
    params.sampler = "random";
    EXPECT_EQ(bake_refusal(mesh, params), "sampler: \"random\" is not one of fibonacci, sobol, halton");
    params = {};
    params.measure = "";
    EXPECT_EQ(bake_refusal(mesh, params), "measure: \"\" is not one of cosine, uniform");
    params = {};
    params.seed = -1;
    EXPECT_EQ(bake_refusal(mesh, params), "seed: -1 is not in [0, 2147483647]");
    params = {};
    params.max_distance = -1;
    EXPECT_EQ(bake_refusal(mesh, params), "max_distance: -1 is not in [1e-30, 1e+30] or \"infinite\"");
    params = {};
    params.max_distance = NAN;
    EXPECT_EQ(bake_refusal(mesh, params), "max_distance: \"nan\" is not a number or \"infinite\"");
    params = {};
    params.margin = -2;
    EXPECT_EQ(bake_refusal(mesh, params), "margin: -2 is not in [0, 32768] or \"infinite\"");
    params = {};
    params.resolution = { 0, 5 };
    EXPECT_EQ(bake_refusal(mesh, params),
              "resolution: \"0x5\" is not WIDTH or WIDTHxHEIGHT in pixels, each from 1 to 32768");
    params = {};
    params.width = 32769;
    EXPECT_EQ(bake_refusal(mesh, params), "width: 32769 is not in [0, 32768]");
    params = {};
    params.channels = { "normal", "coverage", "normal" };
    EXPECT_EQ(bake_refusal(mesh, params), "channels: \"normal\" is given twice");
    params = {};
    params.height = -1;
    EXPECT_EQ(bake_refusal(mesh, params), "height: -1 is not in [0, 32768]");
}

TEST(Vismap, AnInterruptedBakeLeavesNoPixels)
{
    int calls = 0;
    EXPECT_EQ(bake_refusal(floor_facing_z(1), map_params(512, 512, 1), [&](double) { return ++calls < 3; }),
              "interrupted");
    EXPECT_EQ(calls, 3);
}
