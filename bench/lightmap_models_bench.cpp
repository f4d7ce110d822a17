// SPDX-License-Identifier: Apache-2.0
/// All shading models over the texels of a baked mesh, against `paper`: part of lightmap_bench, and counted as there.
#include "lightmap_inputs.h"

#include <vmlight/cfem/stack.h>
#include <vmlight/lightmap/model.h>
#include <vmlight/lightmap/shader.h>
#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/vismap/basis.h>

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

using namespace vmlight;
using OIIO::ImageBuf;

namespace {

struct BenchModel
{
    const ModelEntry* entry;
    int order; // of its basis; 5 where that has no bands
};

// All models but `paper`, which each is compared with; of a basis with bands several.
std::vector<BenchModel> bench_models()
{
    std::vector<BenchModel> models;
    for (const ModelEntry& entry : model_entries()) {
        if (find_basis(entry.basis).parameter == std::string("order"))
            for (const int order : { 4, 5, 6, 8 })
                models.push_back({ &entry, order });
        else if (entry.name != std::string("paper"))
            models.push_back({ &entry, 5 });
    }
    return models;
}

// Texels of a baked mesh, as the model's kernel reads them: what the mesh covers, again and again.
std::vector<float> baked_texels(const BenchModel& model, const LightmapParams& params, ShadingModel& found)
{
    Mesh mesh;
    std::string error;
    VismapParams bake;
    bake.samples = 64;
    bake.margin = 0;
    bake.basis = *model.entry->basis ? model.entry->basis : "vector";
    bake.order = model.order;
    bake.channels = { "normal", "coverage" };
    ImageBuf image;
    if (!read_mesh(mesh, VMLIGHT_BENCH_MESH, {}, error) || !make_vismap(image, mesh, {}, bake)
        || !choose_model(found, params, image.spec(), true, error))
        return {};
    const float* texel = static_cast<const float*>(image.localpixels());
    std::vector<float> texels;
    for (size_t i = 0; i < kTexels; ++i, texel += image.nchannels())
        for (size_t c = 0; c < found.channels.size() && texel[image.nchannels() - 1] > 0; ++c)
            texels.push_back(texel[image.spec().channelindex(found.channels[c])]);
    const size_t once = texels.size();
    for (size_t i = 0; texels.size() < kTexels * found.channels.size(); ++i)
        texels.push_back(texels[i % once]);
    return texels;
}

// The kernels of the models in turn with that of `paper`, on one thread, over the texels of a mesh.
void model_against_paper(benchmark::State& state)
{
    const BenchModel model = bench_models()[size_t(state.range(0))];
    LightmapParams params, paper_params;
    params.model = model.entry->name;
    paper_params.model = "paper";
    params.rotate = paper_params.rotate = { 20, 35, -50 };
    ShadingModel found, plain;
    const std::vector<float> in = baked_texels(model, params, found),
                             four = baked_texels({ find_model_entry("paper"), 5 }, paper_params, plain);
    std::vector<float> out(3 * kTexels), scratch;
    std::vector<ImageBuf> stack;
    LightmapShader shader, paper_shader;
    std::string error;
    if (in.empty() || four.empty() || !make_cfem_stack(stack, environment(), {}, error)
        || !shader.prepare(stack, params, found, error) || !paper_shader.prepare(stack, paper_params, plain, error)) {
        state.SkipWithError("cannot prepare");
        return;
    }
    const OIIO::ROI roi(0, kSide, 0, kSide, 0, 1, 0, 3);
    std::vector<double> paper, other, turn;
    for (auto _ : state) {
        ShadeFaults faults;
        paper.push_back(seconds(
            [&] { paper_shader.shade(roi, TexelLayout::visibility_first, four.data(), out.data(), scratch, faults); }));
        other.push_back(
            seconds([&] { shader.shade(roi, TexelLayout::visibility_first, in.data(), out.data(), scratch, faults); }));
        LightmapShader turned;
        turn.push_back(seconds([&] { turned.prepare(stack, params, found, error); }));
        state.SetIterationTime(other.back());
        if (faults.any())
            state.SkipWithError("faults");
    }
    state.SetLabel(model.entry->name + (model.order != 5 || found.name == "sh" ? std::to_string(model.order) : ""));
    state.counters["ns_per_texel"] = best(other) / kTexels * 1e9;
    state.counters["times_paper"] = best(other) / best(paper);
    state.counters["turn_ms"] = best(turn) * 1e3; // what a new rotation costs before the first texel
}

BENCHMARK(model_against_paper)
    ->ArgName("model")
    ->DenseRange(0, int(bench_models().size()) - 1)
    ->UseManualTime()
    ->MinTime(1);

} // namespace
