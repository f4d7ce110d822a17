// SPDX-License-Identifier: Apache-2.0
/// The relight loop of relight_python.py in C++: prints the best and the median time of a lightmap, in ms.
///
/// Run as: relight_bench VISMAP ENVIRONMENT COUNT THREADS
#include <vmlight/base/stopwatch.h>
#include <vmlight/stage/make_stage.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

using namespace vmlight;

int main(int argc, const char** argv)
{
    if (argc != 5)
        return std::fprintf(stderr, "usage: relight_bench VISMAP ENVIRONMENT COUNT THREADS\n"), 2;
    LightmapRecipe recipe;
    recipe.vismap = argv[1];
    recipe.environment = argv[2];
    const int count = std::max(1, std::atoi(argv[3]));
    MakeOptions options;
    options.threads = std::atoi(argv[4]);
    LightmapInputs inputs;
    std::string error;
    if (!read_lightmap_inputs(inputs, recipe, options, error))
        return std::fprintf(stderr, "relight_bench: %s\n", error.c_str()), 1;
    OIIO::ImageBuf lightmap;
    std::vector<double> times;
    for (int i = 0; i < count; ++i) {
        LightmapParams params;
        params.rotate = { 0, 360.0 * i / count, 0 };
        const Stopwatch timer;
        if (!make_lightmap(lightmap, inputs, params, options, error))
            return std::fprintf(stderr, "relight_bench: %s\n", error.c_str()), 1;
        times.push_back(1e3 * timer());
    }
    std::sort(times.begin(), times.end());
    std::printf("%.4f %.4f\n", times.front(), times[times.size() / 2]);
    return 0;
}
