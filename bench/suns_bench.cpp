// SPDX-License-Identifier: Apache-2.0
/// What traced suns change: the error of `lobe` and `cells` without and with them, against the traced reference, as a
/// Markdown table.
///
///     bench/scenes.py SCENES && suns_bench [PAIRS] SCENES/*.obj ENVIRONMENT...
///
/// Relative RMS error over 128x128 texels with 1024 rays each, against PAIRS (512) pairs of rays, whose noise is taken
/// off. What is left with suns is split: the model's error on the rest, and that of the traced suns, each against a
/// reference of its own; all of the mean light of the whole environment.
///
/// Without an environment: the time of one sun, 60 degrees high, at 1024x1024, in four rotations.
#include <vmlight/base/format.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/cfem/suns.h>
#include <vmlight/lightmap/model_light.h>
#include <vmlight/lightmap/sun_light.h>
#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/reference/reference.h>
#include <vmlight/stage/environment_file.h>
#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/sun_visibility.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/strutil.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>

using namespace vmlight;

namespace {

constexpr const char* kModels[] = { "lobe", "cells" };
int g_pairs = 512;

[[noreturn]] void fail(const std::string& error)
{
    std::fprintf(stderr, "suns_bench: %s\n", error.c_str());
    std::exit(1);
}

std::string stem(const std::string& path)
{
    const std::string file = OIIO::Filesystem::filename(path);
    return file.substr(0, file.find('.'));
}

VismapParams map_of(int side, const char* model)
{
    VismapParams map;
    map.resolution = { side, side };
    map.samples = 1024;
    map.basis = find_model_entry(model)->basis;
    if (map.basis.empty())
        map.basis = "vector";
    return map;
}

struct Light
{
    std::string name;
    OIIO::ImageBuf whole, rest, cut; // the environment; without its suns; they alone
    SunSplit split;
};

// Read a light, and take its suns out of it.
void read_light(Light& light, const std::string& path)
{
    CfemRecipe recipe;
    recipe.environment = path;
    std::string note, error;
    light.name = stem(path);
    if (!read_environment(light.whole, recipe, {}, note, error) || !light.split.find(light.whole, true, error))
        fail(error);
    const Environment rest = light.split.rest(light.whole);
    OIIO::ImageSpec spec(rest.spec().full_width, rest.spec().full_height, 3, OIIO::TypeFloat);
    light.rest.reset(spec);
    light.cut.reset(spec, OIIO::InitializePixels::Yes);
    std::vector<float> row(size_t(spec.width) * size_t(rest.spec().nchannels));
    for (int y = 0; y < spec.height; ++y) {
        const OIIO::ROI roi(0, spec.width, y, y + 1, 0, 1, 0, 3);
        if (!rest.read(roi, row.data(), error))
            fail(error);
        light.rest.set_pixels(roi, OIIO::TypeFloat, row.data());
    }
    if (!light.split.suns().empty())
        OIIO::ImageBufAlgo::sub(light.cut, light.whole, light.rest,
                                OIIO::ROI(0, spec.width, 0, spec.height, 0, 1, 0, 3));
    std::fprintf(stderr, "%s: %.1f %% of the light in %d suns:", light.name.c_str(), 100 * light.split.share(),
                 int(light.split.suns().size()));
    for (const Sun& sun : light.split.suns())
        std::fprintf(stderr, " %.0f high, %.2f wide, %.3g;", std::asin(sun.disc.direction.y) * 180 / M_PI,
                     sun.disc.half_angle * 180 / M_PI, (sun.color[0] + sun.color[1] + sun.color[2]) / 3);
    std::fprintf(stderr, "\n");
}

std::vector<Disc> discs_of(const SunSplit& split)
{
    std::vector<Disc> discs;
    for (const Sun& sun : split.suns())
        discs.push_back(sun.disc);
    return discs;
}

// Of a picture against its reference, in units of the mean of another; and the noise of the reference.
struct Error
{
    double rms = 0, noise = 0;
};

double mean_of(const OIIO::ImageBuf& reference)
{
    double sum = 0, count = 0;
    for (OIIO::ImageBuf::ConstIterator<float> truth(reference); !truth.done(); ++truth)
        for (int c = 0; c < 3 && truth[6] > 0; ++c, ++count)
            sum += double(truth[c]);
    return sum / count;
}

Error error_of(const OIIO::ImageBuf& lit, const OIIO::ImageBuf& reference, double unit)
{
    double squares = 0, noise = 0, count = 0;
    OIIO::ImageBuf::ConstIterator<float> made(lit);
    for (OIIO::ImageBuf::ConstIterator<float> truth(reference); !truth.done(); ++truth, ++made)
        for (int c = 0; c < 3 && truth[6] > 0; ++c, ++count) {
            squares += std::pow(double(made[c]) - double(truth[c]), 2);
            noise += std::pow(double(truth[3 + c]), 2);
        }
    return { std::sqrt(std::max(0.0, squares - noise) / count) / unit, std::sqrt(noise / count) / unit };
}

void trace_reference(OIIO::ImageBuf& dst, const BakeScene& scene, const OIIO::ImageBuf& light)
{
    ReferenceParams params;
    params.samples = g_pairs;
    params.sanitize = true;
    if (!make_reference(dst, scene, light, map_of(128, "lobe"), {}, params, 0, {}))
        fail(dst.geterror());
}

OIIO::ImageBuf light_map(const OIIO::ImageBuf& map, const OIIO::ImageBuf& env, const char* model, const SunLight* suns)
{
    LightmapParams params;
    params.model = model;
    CfemParams filter;
    filter.sanitize = true;
    std::vector<OIIO::ImageBuf> filtered;
    OIIO::ImageBuf lit;
    std::string error;
    if (!make_model_light(filtered, env, filter, find_model_entry(model)->light, error))
        fail(error);
    if (!make_lightmap(lit, map, filtered, suns, params, nullptr, 0, {}))
        fail(lit.geterror());
    return lit;
}

void measure(const std::string& path, const std::vector<Light>& lights)
{
    std::string error;
    auto mesh = std::make_shared<Mesh>();
    auto scene = std::make_shared<BakeScene>();
    SunTracer tracer;
    if (!read_mesh(*mesh, path, {}, error) || !scene->build(mesh, {}, 0, error)
        || !tracer.prepare(scene, map_of(128, "lobe"), error))
        fail(error);
    std::array<OIIO::ImageBuf, std::size(kModels)> maps;
    for (size_t m = 0; m < maps.size(); ++m)
        if (!make_vismap(maps[m], scene, map_of(128, kModels[m]), nullptr, 0, {}))
            fail(maps[m].geterror());
    for (const Light& light : lights) {
        OIIO::ImageBuf whole, rest, cut;
        trace_reference(whole, *scene, light.whole);
        const double mean = mean_of(whole);
        SunLight suns { light.split.suns(), maps[0].roi(), {} };
        tracer.trace(suns.visibility, discs_of(light.split));
        double traced = 0;
        if (!suns.suns.empty()) {
            trace_reference(rest, *scene, light.rest);
            trace_reference(cut, *scene, light.cut);
            OIIO::ImageBuf alone(OIIO::ImageSpec(128, 128, 3, OIIO::TypeFloat), OIIO::InitializePixels::Yes);
            suns.add(suns.roi, 1, static_cast<float*>(alone.localpixels()));
            traced = error_of(alone, cut, mean).rms;
        }
        std::string row = format("| {} | {} | {:.0f} % |", stem(path), light.name, 100 * light.split.share());
        for (size_t m = 0; m < maps.size(); ++m) {
            const double plain = error_of(light_map(maps[m], light.whole, kModels[m], nullptr), whole, mean).rms;
            if (suns.suns.empty()) {
                row += format(" {:.3f} | - | - | - |", plain);
                continue;
            }
            const double split = error_of(light_map(maps[m], light.rest, kModels[m], &suns), whole, mean).rms,
                         model = error_of(light_map(maps[m], light.rest, kModels[m], nullptr), rest, mean).rms;
            row += format(" {:.3f} | {:.3f} | {:.2f} | {:.3f} |", plain, split, split / plain, model);
        }
        std::printf("%s %.3f | %.4f | %.1f |\n", row.c_str(), traced, error_of(whole, whole, mean).noise,
                    double(tracer.rays()) / double(128 * 128));
        std::fflush(stdout);
    }
}

void measure_speed(const std::string& path)
{
    std::string error;
    auto mesh = std::make_shared<Mesh>();
    auto scene = std::make_shared<BakeScene>();
    SunTracer tracer;
    if (!read_mesh(*mesh, path, {}, error) || !scene->build(mesh, {}, 0, error)
        || !tracer.prepare(scene, map_of(1024, "lobe"), error))
        fail(error);
    std::vector<float> seen;
    for (int turn = 0; turn < 4; ++turn) {
        const double e = M_PI / 3, a = turn * M_PI / 2;
        const Disc disc { { std::cos(e) * std::cos(a), std::sin(e), std::cos(e) * std::sin(a) }, 0.265 * M_PI / 180 };
        double least = INFINITY, least_of_cpu = INFINITY;
        for (int run = 0; run < 9; ++run) {
            const Stopwatch timer;
            const std::clock_t before = std::clock();
            tracer.trace(seen, { &disc, 1 });
            least = std::min(least, timer());
            least_of_cpu = std::min(least_of_cpu, double(std::clock() - before) / CLOCKS_PER_SEC);
        }
        const double rays = double(tracer.rays()) * 1e-6;
        std::printf("%s: %.1f ms; %.1f ms of all threads together; %.3f M rays, %.1f M rays/s a thread\n",
                    stem(path).c_str(), 1000 * least, 1000 * least_of_cpu, rays, rays / least_of_cpu);
    }
}

} // namespace

int main(int argc, char** argv)
{
    std::vector<std::string> meshes;
    std::vector<Light> lights;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (OIIO::Strutil::string_is_int(word))
            g_pairs = OIIO::Strutil::stoi(word);
        else if (OIIO::Strutil::iends_with(word, ".obj"))
            meshes.push_back(word);
        else
            read_light(lights.emplace_back(), word);
    }
    if (meshes.empty())
        fail("usage: suns_bench [PAIRS] MESH.obj... [ENVIRONMENT...]");
    if (lights.empty()) {
        for (const std::string& mesh : meshes)
            measure_speed(mesh);
        return 0;
    }
    std::printf(
        "| scene | light | in suns | lobe | +suns | ratio | on the rest | cells | +suns | ratio | on the rest | of "
        "the suns | noise | rays |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const std::string& mesh : meshes)
        measure(mesh, lights);
}
