// SPDX-License-Identifier: Apache-2.0
// How far the models of strands are from ray tracing: for each sky the relative root mean square error over every
// STEP-th texel of a map of strands, single scattering, against (1/pi^2) Int L(w) vis(w) sin(t, w) dw by rays at every
// pixel of the sky. Skies are reduced to 512x256, for models and rays alike.
// `+suns` are the same models of a sky whose suns are split off, and traced.
//     strand_error HAIR RADIUS OCCLUDER STEP RAYS SKY...
#include "strand_texels.h"

#include <vmlight/base/oiio_compat.h>
#include <vmlight/cfem/cfem.h>
#include <vmlight/cfem/radiance.h>
#include <vmlight/cfem/stack.h>
#include <vmlight/cfem/suns.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/lightmap/sun_light.h>
#include <vmlight/math/latlong.h>
#include <vmlight/vismap/strand_suns.h>

#include <OpenImageIO/filesystem.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

using namespace vmlight;
using Imath::V3d;
using Imath::V3f;

namespace {

constexpr int kWidth = 512, kHeight = 256;
constexpr double kRays = 16384; // beside one for each pixel, by its power

[[noreturn]] void fail(const std::string& reason)
{
    std::fprintf(stderr, "strand_error ERROR: %s\n", reason.c_str());
    std::exit(1);
}

double grey(const float* rgb)
{
    return (double(rgb[0]) + double(rgb[1]) + double(rgb[2])) / 3;
}

struct Pixel
{
    double light; // times its solid angle
    int rays, x, y;
};

std::vector<Pixel> pixels_of(const OIIO::ImageBuf& sky)
{
    std::vector<Pixel> pixels;
    double sum = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            float rgb[3];
            sky.getpixel(x, y, rgb, 3);
            pixels.push_back({ grey(rgb) * latlong::row_solid_angle(y, kHeight) / kWidth, 1, x, y });
            sum += pixels.back().light;
        }
    for (Pixel& pixel : pixels)
        pixel.rays += int(kRays * pixel.light / sum);
    return pixels;
}

// The rays of a pixel are jittered over its area.
double traced(const StrandScene& scene, const std::vector<Pixel>& pixels, const CurvePoint& point, int64_t strand,
              uint32_t seed)
{
    const V3f origin = scene.frame().to_scene(point.position);
    const auto radius = float(point.radius * scene.frame().scale);
    RayFan fan(1024);
    std::vector<double> weights;
    double sum = 0;
    const auto flush = [&] {
        std::fill(fan.lanes.begin(), fan.lanes.end(), uint8_t(0));
        for (size_t i = 0; i < weights.size(); ++i)
            fan.lanes[i / kPacketSize] |= uint8_t(1u << i % kPacketSize);
        scene.clear_blocked(fan, origin, radius, uint32_t(strand), std::numeric_limits<float>::infinity());
        for (size_t i = 0; i < weights.size(); ++i)
            sum += fan.lanes[i / kPacketSize] >> i % kPacketSize & 1 ? weights[i] : 0;
        weights.clear();
    };
    for (const Pixel& pixel : pixels)
        for (int ray = 0; ray < pixel.rays; ++ray) {
            const Point32 random = texel_hash(uint32_t(pixel.y * kWidth + pixel.x), uint32_t(ray), seed);
            // Even in the sine of latitude, as area is.
            const double top = std::cos(latlong::pi * pixel.y / kHeight),
                         bottom = std::cos(latlong::pi * (pixel.y + 1) / kHeight);
            const double theta = std::acos(top + (bottom - top) * (random.u * 0x1p-32));
            const V3d w = latlong::direction((pixel.x + random.v * 0x1p-32) / kWidth, theta / latlong::pi);
            const size_t i = weights.size();
            fan.x[i] = float(w.x), fan.y[i] = float(w.y), fan.z[i] = float(w.z);
            weights.push_back(pixel.light / pixel.rays * w.cross(point.tangent).length() / (latlong::pi * latlong::pi));
            if (weights.size() == 1024)
                flush();
        }
    flush();
    return sum;
}

OIIO::ImageBuf bake(const Strands& strands, const StrandScene& scene, const StrandLayout& layout, int order,
                    int rays_each)
{
    VismapParams params;
    params.samples = rays_each;
    params.basis = order ? "sh" : "vector";
    params.order = order ? order : 5;
    const StrandBaker baker(strands, scene, layout, params);
    OIIO::ImageBuf map;
    int64_t rays = 0;
    StrandParams own;
    own.strand_texels = layout.texels;
    const auto begin = std::chrono::steady_clock::now();
    if (!make_strand_map(map, describe_strand_map(strands, layout, own, params), baker, 0, rays))
        fail(map.geterror());
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    std::printf("bake, %d bands: %.1f M rays, %.2f M rays/s\n", order, double(rays) * 1e-6,
                double(rays) * 1e-6 / time.count());
    return map;
}

} // namespace

int main(int argc, const char** argv)
{
    if (argc < 7)
        fail("usage: strand_error HAIR RADIUS OCCLUDER STEP RAYS SKY...");
    std::string error;
    StrandTexels some;
    if (!some.read(argv[1], argv[2], argv[3], std::atoi(argv[4]), error))
        fail(error);
    const Strands& strands = some.strands;
    const StrandScene& scene = some.scene;
    const StrandLayout& layout = some.layout;
    struct Model
    {
        const char* name;
        int order;
        OIIO::ImageBuf map;
    };
    std::vector<Model> models { { "ao", 0, {} }, { "lobe", 0, {} }, { "sh", 4, {} }, { "sh", 5, {} }, { "sh", 8, {} } };
    for (Model& model : models)
        if (&model != &models[1])
            model.map = bake(strands, scene, layout, model.order, std::atoi(argv[5]));
    models[1].map = models[0].map; // both read V and B
    std::printf("%zu texels; relative RMSE of ao, lobe and sh with 4, 5 and 8 bands, each without and with suns\n",
                some.texels.size());
    for (int k = 6; k < argc; ++k) {
        OIIO::ImageBuf sky;
        oiio::resize(sky, OIIO::ImageBuf(argv[k]), OIIO::ROI(0, kWidth, 0, kHeight, 0, 1, 0, 3), 0, "box");
        const std::vector<Pixel> pixels = pixels_of(sky);
        // What the models look up: of the whole sky, and of the rest without suns.
        struct Light
        {
            std::vector<OIIO::ImageBuf> lobes; // the first is what `ao` looks up
            OIIO::ImageBuf radiance;
        } light[2];
        CfemParams filter;
        filter.resolution = { kWidth, kHeight };
        filter.kernel = "strand";
        const auto prepare = [&](Light& dst, const Environment& from) {
            CfemParams unfiltered;
            unfiltered.resolution = filter.resolution;
            if (!make_lobes(dst.lobes, from, filter, error) || !make_radiance(dst.radiance, from, unfiltered, error))
                fail(error);
        };
        SunSplit split;
        SunLight suns;
        const Environment environment(sky);
        if (!split.find(environment, false, error))
            fail(error);
        prepare(light[0], environment);
        prepare(light[1], split.rest(environment));
        suns.suns = split.suns();
        suns.roi = models[0].map.roi();
        suns.roi.chend = 1;
        std::vector<Disc> discs;
        for (const Sun& sun : suns.suns)
            discs.push_back(sun.disc);
        int64_t sun_rays = 0;
        trace_strand_discs(suns.visibility, strands, scene, layout, discs, {}, 0, sun_rays);
        std::vector<OIIO::ImageBuf> lit(2 * models.size());
        for (size_t m = 0; m < lit.size(); ++m) {
            const Model& model = models[m / 2];
            const Light& from = light[m % 2];
            LightmapParams params;
            params.model = model.name;
            const OIIO::cspan<OIIO::ImageBuf> images = model.order ? OIIO::cspan<OIIO::ImageBuf>(&from.radiance, 1)
                : params.model == "ao"                             ? OIIO::cspan<OIIO::ImageBuf>(&from.lobes[0], 1)
                                                                   : OIIO::cspan<OIIO::ImageBuf>(from.lobes);
            if (!make_lightmap(lit[m], model.map, images, m % 2 ? &suns : nullptr, params, nullptr, 0, {}))
                fail(lit[m].geterror());
        }
        std::vector<double> squares(lit.size());
        double mean = 0, noise = 0;
        for (const StrandTexels::Texel& texel : some.texels) {
            // Two truths of their own noise: the product of the errors against them has none, on average.
            const double first = traced(scene, pixels, texel.point, texel.strand, uint32_t(2 * texel.strand + 1)),
                         second = traced(scene, pixels, texel.point, texel.strand, uint32_t(2 * texel.strand + 2));
            mean += (first + second) / 2;
            noise += (first - second) * (first - second) / 4;
            float rgb[3];
            for (size_t m = 0; m < lit.size(); ++m) {
                lit[m].getpixel(texel.x, texel.y, rgb, 3);
                squares[m] += (grey(rgb) - first) * (grey(rgb) - second);
            }
        }
        const double count = double(some.texels.size());
        mean /= count;
        std::printf("%-28s", OIIO::Filesystem::filename(argv[k]).c_str());
        for (const double square : squares)
            std::printf(" %.3f", std::sqrt(std::max(0.0, square / count)) / mean);
        std::printf("   (noise of the truth %.3f)\n", std::sqrt(noise / count) / mean);
    }
    return 0;
}
