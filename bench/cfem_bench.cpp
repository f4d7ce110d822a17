// SPDX-License-Identifier: Apache-2.0
// What the cosine filter costs, and how exact it is.
//     cfem_bench [--benchmark_...] [MAP...]
// Errors are of the exact filter at 128x64 against a double-precision sum with sub-texel quadrature, relative to the
// map's mean: for suns of one texel always, and for each lat-long MAP at 500 pixels of the result.
#include "cfem_brute.h"

#include <vmlight/cfem/cfem.h>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <benchmark/benchmark.h>

#include <chrono>
#include <cstdio>

using namespace vmlight;
using brute::Map;
using brute::V3d;

namespace {

// Soft light and some hard: enough for a timing, which does not depend on the pixels.
OIIO::ImageBuf environment(int width, int height)
{
    OIIO::ImageBuf env(OIIO::ImageSpec(width, height, 3, OIIO::TypeFloat));
    float* pixel = static_cast<float*>(env.localpixels());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int k = 0; k < 3; ++k)
                *pixel++ = float((x * 7 + y * 13 + k * 5) % 31) / 31 + (x % 97 == 0 && y % 89 == 0 ? 1000.0f : 0.0f);
    return env;
}

OIIO::ImageBuf image(const Map& map)
{
    OIIO::ImageBuf buf(OIIO::ImageSpec(map.width, map.height, 3, OIIO::TypeFloat));
    buf.set_pixels(buf.roi(), OIIO::TypeFloat, map.rgb.data());
    return buf;
}

OIIO::ImageBuf filtered(const OIIO::ImageBuf& env, const CfemParams& params, int nthreads)
{
    OIIO::ImageBuf cfem;
    if (!make_cfem(cfem, env, params, nthreads)) {
        std::fprintf(stderr, "%s\n", cfem.geterror().c_str());
        std::exit(1);
    }
    return cfem;
}

// The plain way: a float sum over all texels for each pixel of the result, texels in tiles that stay in the first
// cache, sixteen pixels of the result at a time. Compiled for the instruction sets that the filter's own kernel is.
#if defined(__x86_64__)
__attribute__((target_clones("default", "arch=haswell", "arch=skylake-avx512"), optimize("fp-contract=fast")))
#endif
void brute_float(float* result, const float* texels /* x y z r g b planes, weighted */, size_t count,
                 const float* normals /* planes of `pixels` */, size_t pixels)
{
    constexpr size_t tile = 1024, lanes = 16;
    for (size_t first = 0; first < count; first += tile) {
        const size_t n = std::min(tile, count - first);
        const float *x = texels + first, *y = x + count, *z = y + count;
        const float *r = z + count, *g = r + count, *b = g + count;
        for (size_t p = 0; p < pixels; p += lanes) {
            float nx[lanes], ny[lanes], nz[lanes], sr[lanes] = {}, sg[lanes] = {}, sb[lanes] = {};
            for (size_t i = 0; i < lanes; ++i) {
                nx[i] = normals[p + i];
                ny[i] = normals[pixels + p + i];
                nz[i] = normals[2 * pixels + p + i];
            }
            for (size_t t = 0; t < n; ++t)
                for (size_t i = 0; i < lanes; ++i) {
                    const float d = nx[i] * x[t] + ny[i] * y[t] + nz[i] * z[t];
                    const float c = d > 0 ? d : 0;
                    sr[i] += c * r[t];
                    sg[i] += c * g[t];
                    sb[i] += c * b[t];
                }
            for (size_t i = 0; i < lanes; ++i) {
                result[p + i] += sr[i];
                result[pixels + p + i] += sg[i];
                result[2 * pixels + p + i] += sb[i];
            }
        }
    }
}

std::vector<float> brute_cfem(const OIIO::ImageBuf& env, int width, int height)
{
    const int w = env.spec().width, h = env.spec().height;
    const size_t count = size_t(w) * h, pixels = size_t(width) * height;
    std::vector<float> texels(6 * count), normals(3 * pixels), result(3 * pixels);
    const float* pixel = static_cast<const float*>(env.localpixels());
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            const V3d d = brute::center(x, y, w, h);
            const float weight = float(brute::solid_angle(y, w, h) / brute::pi);
            const size_t t = size_t(y) * w + x;
            for (int k = 0; k < 3; ++k) {
                texels[k * count + t] = float(d[k]);
                texels[(3 + k) * count + t] = pixel[3 * t + k] * weight;
            }
        }
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int k = 0; k < 3; ++k)
                normals[k * pixels + size_t(y) * width + x] = float(brute::center(x, y, width, height)[k]);
    brute_float(result.data(), texels.data(), count, normals.data(), pixels);
    return result;
}

void exact(benchmark::State& state)
{
    const OIIO::ImageBuf env = environment(int(state.range(0)), int(state.range(1)));
    CfemParams params;
    params.resolution = { int(state.range(2)), int(state.range(2)) / 2 };
    for (auto _ : state)
        benchmark::DoNotOptimize(filtered(env, params, int(state.range(3))));
}
BENCHMARK(exact)
    ->ArgNames({ "width", "height", "result", "threads" })
    ->Args({ 1024, 512, 128, 1 })
    ->Args({ 1024, 512, 128, 2 })
    ->Args({ 1024, 1024, 128, 1 })
    ->Args({ 1024, 2048, 128, 1 })
    ->Args({ 1024, 4096, 128, 1 })
    ->Args({ 1024, 512, 256, 1 })
    ->Args({ 1024, 512, 256, 2 })
    ->Args({ 4096, 2048, 256, 1 })
    ->Args({ 4096, 2048, 256, 2 })
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void harmonics(benchmark::State& state)
{
    const OIIO::ImageBuf env = environment(1024, 512);
    CfemParams params;
    params.filter = "sh";
    params.order = int(state.range(0));
    params.resolution = { 128, 64 };
    for (auto _ : state)
        benchmark::DoNotOptimize(filtered(env, params, int(state.range(1))));
}
BENCHMARK(harmonics)
    ->ArgNames({ "order", "threads" })
    ->Args({ 3, 1 })
    ->Args({ 16, 1 })
    ->Args({ 16, 2 })
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

template <class Work> double best_seconds(int repeats, Work&& work)
{
    double best = 1e30;
    for (int i = 0; i < repeats; ++i) {
        const auto start = std::chrono::steady_clock::now();
        work();
        best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    return best;
}

void print_ratio()
{
    const OIIO::ImageBuf env = environment(1024, 512);
    CfemParams params;
    params.resolution = { 128, 64 };
    const double fast = best_seconds(7, [&] { filtered(env, params, 1); });
    std::vector<float> slow_result;
    const double slow = best_seconds(2, [&] { slow_result = brute_cfem(env, 128, 64); });
    std::printf("1024x512 -> 128x64, one thread: exact %.1f ms, float sum over all texels %.1f ms, ratio 1/%.1f\n",
                fast * 1e3, slow * 1e3, slow / fast);
}

// `truth(n)` is C(n) in R, G, B.
template <class Truth>
void print_error(const char* name, const V3d& mean, const OIIO::ImageBuf& cfem, int pixels, Truth&& truth)
{
    const int w = cfem.spec().width, h = cfem.spec().height;
    double worst = 0;
    for (int i = 0; i < pixels; ++i) {
        // An odd step visits other columns in every row.
        const int p = int((int64_t(i) * 2654435761u) % (w * h)), x = p % w, y = p / w;
        const V3d want = truth(brute::center(x, y, w, h));
        for (int k = 0; k < 3; ++k)
            worst = std::max(worst, std::abs(cfem.getchannel(x, y, 0, k) - want[k]) / mean[k]);
    }
    std::printf("%-40s largest error %.1e of the mean\n", name, worst);
}

void print_suns()
{
    CfemParams params;
    params.resolution = { 128, 64 };
    for (int y : { 0, 3, 100, 170, 255, 256, 400, 511 })
        for (int x : { 0, 333 }) {
            const double light = 1e6;
            Map map(1024, 512);
            for (int k = 0; k < 3; ++k)
                map.at(x, y)[k] = float(light);
            const std::string name = "sun of one texel at (" + std::to_string(x) + ", " + std::to_string(y) + ")";
            print_error(name.c_str(), brute::mean(map), filtered(image(map), params, 0), 128 * 64, [&](const V3d& n) {
                return V3d(light * brute::pixel_response(n, x, y, map.width, map.height, 128));
            });
        }
}

void print_map(const char* path)
{
    OIIO::ImageBuf file(path);
    if (!file.read(0, 0, true, OIIO::TypeFloat) || file.nchannels() < 3) {
        std::fprintf(stderr, "%s: %s\n", path, file.geterror().c_str());
        return;
    }
    Map map(file.spec().width, file.spec().height);
    file.get_pixels(OIIO::ROI(0, map.width, 0, map.height, 0, 1, 0, 3), OIIO::TypeFloat, map.rgb.data());
    for (float& value : map.rgb)
        value = std::max(0.0f, value);
    CfemParams params;
    params.resolution = { 128, 64 };
    print_error(path, brute::mean(map), filtered(image(map), params, 0), 500, brute::Filter(map, 12));
}

} // namespace

int main(int argc, char** argv)
{
    std::setvbuf(stdout, nullptr, _IOLBF, 0);
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
    print_ratio();
    print_suns();
    for (int i = 1; i < argc; ++i)
        print_map(argv[i]);
}
