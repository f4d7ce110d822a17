// SPDX-License-Identifier: Apache-2.0
/// What traced suns change: the error of `lobe` and `cells` without and with them, against the traced reference, as a
/// Markdown table.
///
///     bench/scenes.py SCENES && suns_bench SCENES/*.obj ENVIRONMENT...
///
/// Relative RMS error over 128x128 texels with 1024 rays each, against 512 pairs of rays; and what tracing adds to a
/// rotation of a map of 1024x1024 texels.
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
#include <OpenImageIO/strutil.h>

#include <cmath>
#include <cstdio>

using namespace vmlight;

namespace {

constexpr const char* kModels[] = { "lobe", "cells" };

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

double error_of(const OIIO::ImageBuf& lit, const OIIO::ImageBuf& reference)
{
    double squares = 0, noise = 0, sum = 0, count = 0;
    OIIO::ImageBuf::ConstIterator<float> made(lit);
    for (OIIO::ImageBuf::ConstIterator<float> truth(reference); !truth.done(); ++truth, ++made)
        for (int c = 0; c < 3 && truth[6] > 0; ++c, ++count) {
            squares += std::pow(double(made[c]) - double(truth[c]), 2);
            noise += std::pow(double(truth[3 + c]), 2);
            sum += double(truth[c]);
        }
    return std::sqrt(std::max(0.0, squares - noise) / count) / (sum / count);
}

struct Light
{
    std::string name;
    OIIO::ImageBuf image;
    SunSplit split;
};

std::vector<Disc> discs_of(const SunSplit& split)
{
    std::vector<Disc> discs;
    for (const Sun& sun : split.suns())
        discs.push_back(sun.disc);
    return discs;
}

void measure(const std::string& path, const std::vector<Light>& lights)
{
    std::string error;
    auto mesh = std::make_shared<Mesh>();
    auto scene = std::make_shared<BakeScene>();
    SunTracer tracer, large;
    if (!read_mesh(*mesh, path, {}, error) || !scene->build(mesh, {}, 0, error)
        || !tracer.prepare(scene, map_of(128, "lobe"), error) || !large.prepare(scene, map_of(1024, "lobe"), error))
        fail(error);
    std::vector<OIIO::ImageBuf> maps(std::size(kModels));
    for (size_t m = 0; m < maps.size(); ++m)
        if (!make_vismap(maps[m], scene, map_of(128, kModels[m]), nullptr, 0, {}))
            fail(maps[m].geterror());
    for (const Light& light : lights) {
        OIIO::ImageBuf reference;
        ReferenceParams params;
        params.samples = 512;
        params.sanitize = true;
        if (!make_reference(reference, *scene, light.image, map_of(128, "lobe"), {}, params, 0, {}))
            fail(reference.geterror());
        const std::vector<Disc> discs = discs_of(light.split);
        SunLight suns { light.split.suns(), maps[0].roi(), {} };
        tracer.trace(suns.visibility, discs);
        std::string row = format("| {} | {} |", stem(path), light.name);
        for (size_t m = 0; m < maps.size(); ++m) {
            LightmapParams model;
            model.model = kModels[m];
            CfemParams filter;
            filter.sanitize = true;
            double errors[2];
            for (const bool split : { false, true }) {
                std::vector<OIIO::ImageBuf> filtered;
                OIIO::ImageBuf lit;
                const Environment env = split ? light.split.rest(light.image) : Environment(light.image);
                if (!make_model_light(filtered, env, filter, find_model_entry(model.model)->light, error))
                    fail(error);
                if (!make_lightmap(lit, maps[m], filtered, split ? &suns : nullptr, model, nullptr, 0, {}))
                    fail(lit.geterror());
                errors[split] = error_of(lit, reference);
            }
            row += format(" {:.3f} | {:.3f} | {:.2f} |", errors[0], errors[1], errors[1] / errors[0]);
        }
        double least = INFINITY;
        for (int run = 0; run < 5; ++run) {
            const Stopwatch timer;
            large.trace(suns.visibility, discs);
            least = std::min(least, timer());
        }
        std::printf("%s %.0f | %.2f |\n", row.c_str(), 1000 * least, double(large.rays()) * 1e-6);
        std::fflush(stdout);
    }
}

} // namespace

int main(int argc, char** argv)
{
    std::vector<std::string> meshes;
    std::vector<Light> lights;
    for (int i = 1; i < argc; ++i) {
        const std::string path = argv[i];
        if (OIIO::Strutil::iends_with(path, ".obj")) {
            meshes.push_back(path);
            continue;
        }
        Light& light = lights.emplace_back();
        CfemRecipe recipe;
        recipe.environment = path;
        std::string note, error;
        light.name = stem(path);
        if (!read_environment(light.image, recipe, {}, note, error) || !light.split.find(light.image, true, error))
            fail(error);
    }
    if (meshes.empty() || lights.empty())
        fail("usage: suns_bench MESH.obj... ENVIRONMENT...");
    std::printf("| scene | light | lobe | +suns | ratio | cells | +suns | ratio | ms | M rays "
                "|\n|---|---|---|---|---|---|---|---|---|---|\n");
    for (const std::string& mesh : meshes)
        measure(mesh, lights);
}
