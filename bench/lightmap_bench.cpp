// SPDX-License-Identifier: Apache-2.0
/// Shading of a 1024x1024 visibility map with a 256x128 CFEM, memory to memory, against the time it takes to stream
/// the same bytes: 16 read and 12 written per texel.
///
/// Counters: ns per texel, and ratios to a run of the other kind taken in turn with it, so that both see the same
/// machine. Times are the best of the run. Two contents: `smooth`, where neighbours look along like directions, as in a
/// baked chart; `random`, where each texel looks anywhere, the worst case for the cache that holds the CFEM.
#include <vmlight/cfem/stack.h>
#include <vmlight/image/channels.h>
#include <vmlight/lightmap/model.h>
#include <vmlight/lightmap/model_lobe.h>
#include <vmlight/lightmap/model_paper.h>
#include <vmlight/lightmap/shader.h>
#include <vmlight/math/latlong.h>
#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/vismap/basis.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <random>

using namespace vmlight;
using OIIO::ImageBuf;
using OIIO::ImageSpec;

namespace {

constexpr int kSide = 1024;
constexpr size_t kTexels = size_t(kSide) * kSide;

enum Content
{
    smooth,
    random_directions
};

ImageBuf visibility_map(Content content)
{
    ImageSpec spec(kSide, kSide, 4, OIIO::TypeFloat);
    spec.channelnames.assign(kVismapChannels.begin(), kVismapChannels.end());
    ImageBuf image(spec);
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0, 1);
    float* texel = static_cast<float*>(image.localpixels());
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x, texel += 4) {
            const float s = content == smooth ? (x + 0.5f) / kSide : unit(random);
            const float t = content == smooth ? (y + 0.5f) / kSide : std::acos(1 - 2 * unit(random)) / 3.1415927f;
            const float v = content == smooth ? 0.5f + 0.4f * std::sin(20 * s) * std::sin(20 * t) : unit(random);
            const Imath::V3f b = latlong::direction(s, t) * (v * (1 - v / 3));
            texel[0] = v, texel[1] = b.x, texel[2] = b.y, texel[3] = b.z;
        }
    return image;
}

ImageBuf environment()
{
    ImageBuf image(ImageSpec(256, 128, 3, OIIO::TypeFloat));
    float* pixel = static_cast<float*>(image.localpixels());
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 256; ++x, pixel += 3) {
            const Imath::V3f d = latlong::direction((x + 0.5f) / 256, (y + 0.5f) / 128);
            pixel[0] = 1 + 0.5f * d.x, pixel[1] = 1 + 0.5f * d.y, pixel[2] = 1 + 0.5f * d.z * d.x;
        }
    return image;
}

// Three loops that the compiler makes vectors of; the last quarter of a block's input is in the first-level cache
// when it is read again, so that memory is read once.
void stream(const float* __restrict in, float* __restrict out)
{
    constexpr size_t block = 256;
    for (size_t i = 0; i < kTexels; i += block, in += 4 * block, out += 3 * block)
        for (size_t c = 0; c < 3; ++c)
            for (size_t k = 0; k < block; ++k)
                out[c * block + k] = in[c * block + k] + in[3 * block + k];
    benchmark::ClobberMemory();
}

template <class Work> double seconds(Work&& work)
{
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Other work on the machine only ever adds time.
double best(const std::vector<double>& times)
{
    return *std::min_element(times.begin(), times.end());
}

// The kernel alone, one thread, in turn with streaming.
void shading_against_streaming(benchmark::State& state)
{
    const ImageBuf vismap = visibility_map(Content(state.range(0)));
    const float* in = static_cast<const float*>(vismap.localpixels());
    std::vector<float> out(3 * kTexels);
    CfemLookup cfem;
    std::string error;
    if (!prepare_cfem(cfem, environment(), error))
        state.SkipWithError(error.c_str());
    const ShadeSetup setup { { 0.36f, 0.48f, -0.8f, -0.8f, 0.6f, 0, 0.48f, 0.64f, 0.6f }, 1 };

    std::vector<double> shading, streaming;
    for (auto _ : state) {
        streaming.push_back(seconds([&] { stream(in, out.data()); }));
        shading.push_back(seconds([&] {
            shade_paper(cfem, setup, TexelLayout::visibility_first, in, kTexels, out.data());
            benchmark::ClobberMemory();
        }));
        state.SetIterationTime(shading.back());
    }
    state.counters["ns_per_texel"] = best(shading) / kTexels * 1e9;
    state.counters["stream_ns"] = best(streaming) / kTexels * 1e9;
    state.counters["times_stream"] = best(shading) / best(streaming);
}

// The kernels of the models in turn on one thread; a stack has the sizes that make_cfem_stack() gives it.
void lobe_against_paper(benchmark::State& state)
{
    const ImageBuf vismap = visibility_map(Content(state.range(0)));
    const float* in = static_cast<const float*>(vismap.localpixels());
    std::vector<float> out(3 * kTexels);
    std::vector<ImageBuf> stack;
    CfemLookup cfem;
    LobeLookup lobes;
    std::string error;
    if (!make_cfem_stack(stack, environment(), {}, error) || !prepare_cfem(cfem, stack[0], error)
        || !prepare_lobes(lobes, OIIO::cspan<ImageBuf>(stack.data(), kStackLevels), error)) {
        state.SkipWithError(error.c_str());
        return;
    }
    const ShadeSetup setup { { 0.36f, 0.48f, -0.8f, -0.8f, 0.6f, 0, 0.48f, 0.64f, 0.6f }, 1 };

    std::vector<double> paper, lobe;
    for (auto _ : state) {
        paper.push_back(
            seconds([&] { shade_paper(cfem, setup, TexelLayout::visibility_first, in, kTexels, out.data()); }));
        lobe.push_back(
            seconds([&] { shade_lobe(lobes, setup, TexelLayout::visibility_first, in, kTexels, out.data()); }));
        state.SetIterationTime(lobe.back());
    }
    state.counters["ns_per_texel"] = best(lobe) / kTexels * 1e9;
    state.counters["paper_ns"] = best(paper) / kTexels * 1e9;
    state.counters["times_paper"] = best(lobe) / best(paper);
}

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

// make_lightmap() as a turntable calls it, on one thread and two in turn.
void one_thread_against_two(benchmark::State& state)
{
    const ImageBuf vismap = visibility_map(Content(state.range(0))), cfem = environment();
    ImageBuf dst;
    LightmapParams params;
    params.rotate = { 20, 35, -50 };
    std::vector<double> one, two;
    for (auto _ : state) {
        one.push_back(seconds([&] { make_lightmap(dst, vismap, cfem, params, nullptr, 1); }));
        two.push_back(seconds([&] { make_lightmap(dst, vismap, cfem, params, nullptr, 2); }));
        state.SetIterationTime(two.back());
    }
    if (dst.has_error())
        state.SkipWithError(dst.geterror().c_str());
    state.counters["ns_per_texel_1"] = best(one) / kTexels * 1e9;
    state.counters["ns_per_texel_2"] = best(two) / kTexels * 1e9;
    state.counters["speedup"] = best(one) / best(two);
}

// What the vector form gains over its definition.
void scalar_shading(benchmark::State& state)
{
    const ImageBuf vismap = visibility_map(Content(state.range(0)));
    std::vector<float> out(3 * kTexels);
    CfemLookup cfem;
    std::string error;
    if (!prepare_cfem(cfem, environment(), error))
        state.SkipWithError(error.c_str());
    const ShadeSetup setup { { 0.36f, 0.48f, -0.8f, -0.8f, 0.6f, 0, 0.48f, 0.64f, 0.6f }, 1 };
    for (auto _ : state) {
        shade_paper_scalar(cfem, setup, TexelLayout::visibility_first, static_cast<const float*>(vismap.localpixels()),
                           kTexels, out.data());
        benchmark::ClobberMemory();
    }
    state.counters["ns_per_texel"] = benchmark::Counter(double(state.iterations()) * kTexels * 1e-9,
                                                        benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

// A map of strands, each texel with a tangent of its own, relit on one thread: by `ao` for 0 bands, else by `sh`.
void relighting_strands(benchmark::State& state)
{
    const int bands = int(state.range(0)), harmonics = bands * bands;
    std::vector<std::string> names(kVismapChannels.begin(), kVismapChannels.end());
    names.insert(names.end(), kTangentChannels.begin(), kTangentChannels.end());
    for (int i = 4; i < harmonics; ++i)
        names.push_back("sh." + std::to_string(i));
    ImageSpec spec(kSide, kSide, int(names.size()), OIIO::TypeFloat);
    spec.channelnames = names;
    spec.attribute("vmlight:kernel", kStrandKernel);
    spec.attribute("vmlight:stage", kVismapStage);
    ImageBuf map(spec), dst;
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0, 1);
    float* texel = static_cast<float*>(map.localpixels());
    for (size_t i = 0; i < kTexels; ++i, texel += spec.nchannels) {
        const Imath::V3f t = latlong::direction(unit(random), std::acos(1 - 2 * unit(random)) / 3.1415927f);
        const float v = unit(random);
        texel[0] = v, texel[1] = .3f * v * t.y, texel[2] = .3f * v * t.z, texel[3] = .3f * v * t.x;
        texel[4] = t.x, texel[5] = t.y, texel[6] = t.z;
        for (int c = 7; c < spec.nchannels; ++c)
            texel[c] = .01f * v;
    }
    CfemParams filter;
    LightmapParams params;
    params.model = bands ? "sh" : "ao";
    params.rotate = { 20, 35, -50 };
    std::vector<ImageBuf> light(1);
    std::string error;
    filter.kernel = bands ? kCosineKernel : kStrandKernel;
    if (!(bands ? make_cfem_stack(light, environment(), filter, error) : make_cfem(light[0], environment(), filter))) {
        state.SkipWithError("cannot filter");
        return;
    }
    std::vector<double> times;
    for (auto _ : state) {
        times.push_back(seconds([&] { make_lightmap(dst, map, light, params, nullptr, 1); }));
        state.SetIterationTime(times.back());
    }
    if (dst.has_error())
        state.SkipWithError(dst.geterror().c_str());
    state.counters["ns_per_texel"] = best(times) / kTexels * 1e9;
}

const std::vector<int64_t> kContents { smooth, random_directions };

BENCHMARK(shading_against_streaming)->ArgName("random")->ArgsProduct({ kContents })->UseManualTime()->MinTime(1);
BENCHMARK(lobe_against_paper)->ArgName("random")->ArgsProduct({ kContents })->UseManualTime()->MinTime(1);
BENCHMARK(model_against_paper)
    ->ArgName("model")
    ->DenseRange(0, int(bench_models().size()) - 1)
    ->UseManualTime()
    ->MinTime(1);
BENCHMARK(one_thread_against_two)->ArgName("random")->ArgsProduct({ kContents })->UseManualTime()->MinTime(1);
BENCHMARK(relighting_strands)->ArgName("bands")->Arg(0)->Arg(4)->Arg(5)->UseManualTime()->MinTime(1);
BENCHMARK(scalar_shading)->ArgName("random")->ArgsProduct({ kContents });

} // namespace
