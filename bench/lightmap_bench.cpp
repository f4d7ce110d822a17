// SPDX-License-Identifier: Apache-2.0
/// Shading of a 1024x1024 visibility map with a 256x128 CFEM, memory to memory, against the time it takes to stream
/// the same bytes: 16 read and 12 written per texel.
///
/// Counters: ns per texel, and ratios to a run of the other kind taken in turn with it, so that both see the same
/// machine. Times are the best of the run. Two contents: `smooth`, where neighbours look along like directions, as in a
/// baked chart; `random`, where each texel looks anywhere, the worst case for the cache that holds the CFEM.
#include "lightmap_inputs.h"

#include <vmlight/cfem/stack.h>
#include <vmlight/image/channels.h>
#include <vmlight/lightmap/model_lobe.h>
#include <vmlight/lightmap/model_paper.h>
#include <vmlight/lightmap/shader.h>
#include <vmlight/math/latlong.h>

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

using namespace vmlight;
using OIIO::ImageBuf;
using OIIO::ImageSpec;

namespace {

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
BENCHMARK(one_thread_against_two)->ArgName("random")->ArgsProduct({ kContents })->UseManualTime()->MinTime(1);
BENCHMARK(relighting_strands)->ArgName("bands")->Arg(0)->Arg(4)->Arg(5)->UseManualTime()->MinTime(1);
BENCHMARK(scalar_shading)->ArgName("random")->ArgsProduct({ kContents });

} // namespace
