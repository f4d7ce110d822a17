// SPDX-License-Identifier: Apache-2.0
/// What cut-outs cost, and what opacity micromaps save:
///     cutout_bench LEAVES.obj [resolution samples threads width textures]
/// LEAVES.obj is that of bench/scenes.py: its quads of a quarter of a unit are leaves, each of which gets one of
/// several equal alpha textures (1, 512 texels wide), in uvs of its own or in those of the atlas. The rays of a bake
/// are traced through the same scene, first opaque, then with micromaps, with the texture in memory at every hit, and
/// with OpenImageIO's texture system at every hit. All take turns; ratios of medians are printed, and whether the same
/// rays are open.
#include "texture_system_scene.h"

#include <vmlight/base/parallel.h>
#include <vmlight/math/sampling.h>
#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/mesh/opacity.h>
#include <vmlight/trace/embree_scene.h>
#include <vmlight/trace/surface.h>
#include <vmlight/uv/raster.h>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

using namespace vmlight;
using Imath::V2f;
using Imath::V3d;
using Imath::V3f;

namespace {

int g_side = 512; // of a texture
int g_textures = 1;
constexpr float kFar = std::numeric_limits<float>::infinity();

/// An ellipse with teeth, of which about three fifths of the card are opaque.
std::vector<float> leaf_texels()
{
    std::vector<float> texels;
    for (int y = 0; y < g_side; ++y)
        for (int x = 0; x < g_side; ++x) {
            const double s = (x + 0.5) / g_side * 2 - 1, t = (y + 0.5) / g_side * 2 - 1;
            const double r = std::hypot(s, t * 1.2) + 0.05 * std::sin(24 * std::atan2(t, s));
            texels.push_back(float(std::min(1.0, std::max(0.0, (0.95 - r) * g_side / 8 + 0.5))));
        }
    return texels;
}

bool is_leaf(const Mesh& mesh, size_t triangle)
{
    const auto& t = mesh.triangles[triangle];
    return (mesh.positions[t[1]] - mesh.positions[t[0]]).length() < 0.36;
}

/// The corners of quads in the order of OBJ faces: (0, 1, 2), (0, 2, 3).
std::vector<V2f> leaf_uvs(const Mesh& mesh, bool of_the_atlas)
{
    const V2f corners[2][3] = { { V2f(0, 0), V2f(1, 0), V2f(1, 1) }, { V2f(0, 0), V2f(1, 1), V2f(0, 1) } };
    std::vector<V2f> uvs;
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
        for (size_t k = 0; k < 3; ++k) {
            const V2f own = mesh.uvs[mesh.triangles[t][k]];
            // A little apart from leaf to leaf: no two have the same micromap.
            uvs.push_back(corners[t % 2][k] + (of_the_atlas ? own * 1e-3f : V2f(0)));
        }
    return uvs;
}

Mesh with_leaves(Mesh mesh, bool of_the_atlas)
{
    auto opacity = std::make_shared<MeshOpacity>();
    opacity->materials.resize(size_t(1 + g_textures));
    for (int i = 1; i <= g_textures; ++i) {
        opacity->materials[size_t(i)].mode = AlphaMode::mask;
        opacity->materials[size_t(i)].textures[0].image
            = std::make_shared<AlphaTexture>(g_side, g_side, leaf_texels(), TextureWrap::clamp, TextureWrap::clamp);
    }
    opacity->uvs = { leaf_uvs(mesh, of_the_atlas) };
    mesh.materials.resize(size_t(1 + g_textures));
    mesh.triangle_materials.resize(mesh.triangles.size());
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
        mesh.triangle_materials.set(t, is_leaf(mesh, t) ? uint32_t(1 + t / 2 % size_t(g_textures)) : 0);
    mesh.opacity = opacity;
    return mesh;
}

/// Of this thread: what else runs does not count.
double cpu_seconds()
{
    timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

using Clear = std::function<void(RayFan& fan, const SurfacePoint& point)>;

/// Trace the rays of a bake; append the open ones.
double trace(const Mesh& mesh, const SceneFrame& frame, const Occluder& near, const UvRaster& raster,
             const SamplePattern& pattern, int threads, const Clear& clear, std::vector<uint8_t>& open)
{
    const int tiles = raster.tiles_across() * raster.tiles_down();
    std::vector<std::vector<uint8_t>> parts(static_cast<size_t>(tiles));
    std::vector<double> seconds(static_cast<size_t>(tiles));
    parallel_items(tiles, threads, [&](int64_t tile, int) {
        const double start = cpu_seconds();
        TileCover cover;
        Surface surface(mesh, frame);
        RayFan fan(pattern.count());
        raster.cover(int(tile), cover);
        for (int i = 0; i < kTileSize * kTileSize; ++i) {
            const int block = i / 64, x = block % 8 * 8 + i % 8, y = block / 8 * 8 + i / 8 % 8;
            const size_t texel = size_t(y) * kTileSize + size_t(x);
            if (cover.triangle[texel] == TileCover::kNone)
                continue;
            SurfacePoint point = surface.at(cover.triangle[texel], cover.weight1[texel], cover.weight2[texel]);
            adjust_ray_origins(&point, 1, near);
            const Point32 hash = texel_hash(uint32_t(tile * 4096) + uint32_t(texel), 0, 0);
            pattern.directions(fan, TangentFrame(point.normal), point.geometric_normal, hash);
            clear(fan, point);
            parts[size_t(tile)].insert(parts[size_t(tile)].end(), fan.lanes.begin(), fan.lanes.end());
        }
        seconds[size_t(tile)] = cpu_seconds() - start;
    });
    double sum = 0;
    for (size_t tile = 0; tile < parts.size(); ++tile) {
        open.insert(open.end(), parts[tile].begin(), parts[tile].end());
        sum += seconds[tile];
    }
    return sum;
}

struct Way
{
    const char* name;
    Clear clear;
    std::vector<double> seconds;
    std::vector<uint8_t> open;

    double median()
    {
        std::sort(seconds.begin(), seconds.end());
        return seconds[seconds.size() / 2];
    }
};

int64_t differing(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b)
{
    int64_t count = 0;
    for (size_t i = 0; i < a.size(); ++i)
        count += __builtin_popcount(a[i] ^ b[i]);
    return count;
}

} // namespace

int main(int argc, const char** argv)
{
    if (argc < 2) {
        std::printf("usage: cutout_bench LEAVES.obj [resolution samples threads width textures]\n");
        return 2;
    }
    const int resolution = argc > 2 ? std::atoi(argv[2]) : 512, samples = argc > 3 ? std::atoi(argv[3]) : 64;
    const int threads = argc > 4 ? std::atoi(argv[4]) : 1;
    g_side = argc > 5 ? std::atoi(argv[5]) : g_side;
    g_textures = argc > 6 ? std::atoi(argv[6]) : g_textures;
    Mesh leaves;
    std::string error;
    if (!read_mesh(leaves, argv[1], {}, error)) {
        std::printf("%s\n", error.c_str());
        return 1;
    }
    const std::filesystem::path folder = std::filesystem::temp_directory_path();
    std::vector<std::string> textures;
    OIIO::ImageSpec spec(g_side, g_side, 1, OIIO::TypeFloat);
    std::vector<float> texels = leaf_texels();
    OIIO::ImageBuf image(spec, texels.data());
    image.set_write_tiles(64, 64);
    for (int i = 0; i < g_textures; ++i) {
        textures.push_back(folder / ("cutout_bench_leaf" + std::to_string(i) + ".exr"));
        image.write(textures.back());
    }

    const SceneFrame frame = SceneFrame::around(leaves);
    const UvRaster raster(leaves, resolution, resolution);
    const SamplePattern pattern("fibonacci", samples, false);
    for (const bool of_the_atlas : { false, true }) {
        const Mesh cut = with_leaves(leaves, of_the_atlas);
        Occluder opaque, micromaps, every_hit;
        double before = cpu_seconds();
        const auto lap = [&] { return cpu_seconds() - std::exchange(before, cpu_seconds()); };
        bool good = opaque.build({ &leaves }, frame, threads, error);
        const double plain_build = lap();
        good = good && micromaps.build({ &cut }, frame, threads, error);
        const double micromap_build = lap();
        if (!good || !every_hit.build({ &cut }, frame, threads, error, CutoutMode::every_hit)) {
            std::printf("%s\n", error.c_str());
            return 1;
        }
        const TextureSystemScene system(cut, frame, textures);
        const auto by = [](const Occluder& occluder) {
            return [&](RayFan& fan, const SurfacePoint& point) {
                occluder.clear_blocked(fan, point.origin, kFar, point.is_near);
            };
        };
        std::vector<Way> ways { { "opaque", by(opaque), {}, {} },
                                { "micromaps", by(micromaps), {}, {} },
                                { "texture in memory", by(every_hit), {}, {} },
                                { "texture system",
                                  [&](RayFan& fan, const SurfacePoint& point) {
                                      system.clear_blocked(fan, point.origin);
                                  },
                                  {},
                                  {} } };
        for (int round = 0; round < 5; ++round)
            for (Way& way : ways) {
                way.open.clear();
                way.seconds.push_back(trace(leaves, frame, opaque, raster, pattern, threads, way.clear, way.open));
            }
        const CutoutCounts& counts = micromaps.cutouts();
        const CutoutWork work = micromaps.cutout_work();
        const double rays = double(ways[0].open.size()) * 8;
        std::printf("%s: %lld mixed triangles, %lld cells, %.2f %% of them unknown, %.1f MB; build %.3f s, opaque "
                    "%.3f s; %.2f hits a ray, %.2f %% of them ask the texture\n",
                    of_the_atlas ? "uvs of its own for each leaf" : "all leaves in the same uvs",
                    (long long)counts.mixed, (long long)counts.cells,
                    100.0 * double(counts.unknown) / double(std::max<int64_t>(1, counts.cells)),
                    double(counts.bytes) * 1e-6, micromap_build, plain_build, double(work.hits) / 5 / rays,
                    100.0 * double(work.lookups) / double(std::max<int64_t>(1, work.hits)));
        for (Way& way : ways)
            std::printf("  %-18s %7.1f ns a ray, %.2f of opaque, %.2f of micromaps; %lld of %.0f rays differ from "
                        "micromaps\n",
                        way.name, way.median() / rays * 1e9, way.median() / ways[0].median(),
                        way.median() / ways[1].median(), (long long)differing(way.open, ways[1].open), rays);
    }
    for (const std::string& texture : textures)
        std::filesystem::remove(texture);
    return 0;
}
