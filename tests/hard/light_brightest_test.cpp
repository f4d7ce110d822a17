// SPDX-License-Identifier: Apache-2.0
// No surface is lit brighter than one that is open and faces the light.
#include "hard_case.h"

#include "baked_map.h"
#include "scenes.h"
#include "stack_maps.h"

#include <vmlight/base/format.h>
#include <vmlight/lightmap/model.h>
#include <vmlight/math/longest_direction.h>

#include <vector>

using namespace vmlight;
using Imath::V3d;
using Imath::V3f;
using OIIO::ImageBuf;
using scene::filtered_stack;
using scene::lit;
using scene::pixels;

namespace {

struct NamedBake
{
    std::string name;
    Mesh mesh;
    std::vector<Mesh> occluders;
};

// Smooth normals on few triangles lean off their facets by up to 37 degrees.
std::vector<NamedBake> scenes_of_few_triangles()
{
    std::vector<NamedBake> all { { "a ball of 20 triangles", scenes::icosphere(0), {} },
                                 { "a ball of 80 triangles", scenes::icosphere(1), {} } };
    NamedBake leaning { "normals that lean", {}, {} };
    for (int i = 0; i < 5; ++i) {
        const double angle[] = { 40, 60, 75, 85, 89 };
        scenes::add_quad(leaning.mesh, V3d(2 * i, 0, 0), V3d(2 * i + 1, 0, 0), V3d(2 * i + 1, 1, 0), V3d(2 * i, 1, 0),
                         Imath::V2f(0.2f * float(i), 0), Imath::V2f(0.2f * float(i + 1), 1));
        for (size_t k = leaning.mesh.normals.size() - 4; k < leaning.mesh.normals.size(); ++k)
            leaning.mesh.normals[k]
                = V3f(float(std::sin(angle[i] * M_PI / 180)), 0, float(std::cos(angle[i] * M_PI / 180)));
    }
    all.push_back(leaning);
    // Balls on a plane, and a street between boxes.
    NamedBake balls { "balls on a plane", scenes::placed(scenes::icosphere(0), 0.5, V3d(0, 0, 0.45)), {} };
    balls.occluders.push_back(scenes::floor_facing_z(9));
    for (int i = 0; i < 12; ++i)
        balls.occluders.push_back(scenes::placed(scenes::icosphere(0), 0.3 + 0.03 * i,
                                                 V3d(1.2 * std::cos(i * 2.4), 1.2 * std::sin(i * 2.4), 0.3)));
    all.push_back(balls);
    NamedBake city { "a city", scenes::floor_facing_z(1), {} };
    for (int i = 0; i < 9; ++i)
        city.occluders.push_back(
            scenes::box(V3d(i % 3 - 1.3, i / 3 - 1.3, 0), V3d(i % 3 - 0.8, i / 3 - 0.8, 0.4 + 0.2 * i), false));
    all.push_back(city);
    // All but a hole above.
    NamedBake well { "a deep well", scenes::floor_facing_z(0.02), {} };
    well.occluders.push_back(scenes::tube(0.2, 1, 60));
    all.push_back(well);
    return all;
}

ImageBuf vismap_of(const NamedBake& scene, const std::string& basis, int samples, const std::string& measure = "cosine")
{
    VismapParams params = map_params(48, 48, samples);
    params.channels = { "normal" };
    params.basis = basis;
    params.measure = measure;
    ImageBuf map;
    EXPECT_TRUE(make_vismap(map, scene.mesh, scene.occluders, params)) << map.geterror();
    return map;
}

// A sun of one pixel in a sky that is a millionth as bright.
ImageBuf sun(int place)
{
    const int width = 128, height = 64;
    ImageBuf sky = scene::cfem(width, height, [](V3d) { return V3f(1, 2, 3); });
    const float bright[] = { 4e6f, 3e6f, 2e6f };
    sky.setpixel(place % width, place / width, bright, 3);
    return sky;
}

float largest(const ImageBuf& image, int channel)
{
    float most = 0;
    for (int y = 0; y < image.spec().height; ++y)
        for (int x = 0; x < image.spec().width; ++x)
            most = std::max(most, image.getchannel(x, y, 0, channel));
    return most;
}

} // namespace

TEST(Light, ASmallSunOnABallOfFewTriangles)
{
    HardCase row(
        "A sun of one pixel on balls of 20 and 80 triangles with smooth normals, quads whose normals lean by 40 to "
        "89 degrees, balls on a plane, a city and a well, with 16 and 256 rays");
    row.naive(
        "rays below the facet are dropped and B is that of the rest: up to 1.97 times as bright as the brightest point "
        "of the cosine-filtered map (measured)");
    std::vector<std::vector<ImageBuf>> stacks;
    for (const int place :
         { 30, 3 * 128 + 90, 20 * 128 + 17, 31 * 128 + 64, 45 * 128 + 99, 31 * 128 + 32, 31 * 128 + 40 })
        stacks.push_back(filtered_stack(sun(place), 128));
    double most = 0;
    const auto check = [&](const NamedBake& scene, const ModelEntry& entry, int samples) {
        const ImageBuf map = vismap_of(scene, *entry.basis ? entry.basis : "vector", samples);
        for (const std::vector<ImageBuf>& stack : stacks) {
            const ImageBuf image = lit(map, stack, scene::model(entry.name));
            for (int c = 0; c < 3; ++c) {
                const double ratio = double(largest(image, c)) / double(largest(stack[0], c));
                most = std::max(most, ratio);
                // `sh`, `mask` and `cells` know the brightest point from a coarser map.
                EXPECT_LT(ratio, entry.light == ModelLight::radiance ? 1.002 : 1.00002)
                    << scene.name << " " << entry.name << " " << samples << " rays";
            }
        }
    };
    for (const NamedBake& scene : scenes_of_few_triangles())
        for (const ModelEntry& entry : model_entries())
            for (const int samples : { 16, 256 })
                check(scene, entry, samples);
    EXPECT_GT(most, 0.99); // one of them faces the sun
    row.ours("never brighter than that point, with every model");
}

TEST(Light, NoSurfaceSeesLessOfTheSkyThanACap)
{
    HardCase row("|B| of the same bakes, and of the measure `uniform`");
    row.naive("up to 0.8 for V = 1 where normals lean, though no surface can have more than 2/3 (measured)");
    for (const NamedBake& scene : scenes_of_few_triangles())
        for (const int samples : { 1, 16, 256 })
            for (const char* const measure : { "cosine", "uniform" }) {
                const ImageBuf map = vismap_of(scene, "vector", samples, measure);
                for (int i = 0; i < 48 * 48; ++i) {
                    const float* texel = pixels(map) + i * map.nchannels();
                    ASSERT_LE(V3d(texel[1], texel[2], texel[3]).length(),
                              longest_direction(double(texel[0])) * (1 + 2e-6))
                        << scene.name << " " << samples << " " << measure << " texel " << i;
                }
            }
    row.ours("at most (2/3) (1 - (1 - V)^(3/2)), that of a cap around the normal");
}
