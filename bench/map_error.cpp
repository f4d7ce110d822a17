// SPDX-License-Identifier: Apache-2.0
/// The error of visibility maps against one of many rays that has the channel `coverage`:
///
///     map_error TRUTH.exr MAP.exr ...
///
/// prints a line for each map: root mean square, 99th percentile and largest error of V, then those of B as a vector,
/// over the covered texels; then the root mean square of the channel `error`, or 0.
#include <OpenImageIO/imagebuf.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace {

using OIIO::ImageBuf;

struct Channels
{
    explicit Channels(const OIIO::ImageSpec& spec)
    {
        const char* names[] = { "visibility", "direction.x", "direction.y", "direction.z" };
        for (int c = 0; c < 4; ++c)
            map[c] = spec.channelindex(names[c]);
        coverage = spec.channelindex("coverage");
        error = spec.channelindex("error");
    }
    int map[4];
    int coverage, error;
};

void print_errors(std::vector<double>& errors)
{
    double squares = 0;
    for (const double error : errors)
        squares += error * error;
    std::sort(errors.begin(), errors.end());
    const auto rank = size_t(0.99 * double(errors.size() - 1));
    std::printf(" %.6f %.6f %.6f", std::sqrt(squares / double(errors.size())), errors[rank], errors.back());
}

bool compare(const ImageBuf& truth, const char* path)
{
    ImageBuf map(path);
    if (!map.read(0, 0, true, OIIO::TypeDesc::FLOAT) || map.spec().width != truth.spec().width
        || map.spec().height != truth.spec().height) {
        std::fprintf(stderr, "map_error: cannot compare \"%s\"\n", path);
        return false;
    }
    const Channels of(truth.spec()), in(map.spec());
    std::vector<double> visibility, direction;
    double stated = 0;
    for (int y = 0; y < truth.spec().height; ++y)
        for (int x = 0; x < truth.spec().width; ++x) {
            if (truth.getchannel(x, y, 0, of.coverage) == 0)
                continue;
            double squares = 0;
            for (int c = 0; c < 4; ++c) {
                const double error
                    = double(map.getchannel(x, y, 0, in.map[c])) - double(truth.getchannel(x, y, 0, of.map[c]));
                if (c == 0)
                    visibility.push_back(std::abs(error));
                else
                    squares += error * error;
            }
            direction.push_back(std::sqrt(squares));
            if (in.error >= 0)
                stated += std::pow(double(map.getchannel(x, y, 0, in.error)), 2);
        }
    if (visibility.empty()) {
        std::fprintf(stderr, "map_error: no texel is covered\n");
        return false;
    }
    print_errors(visibility);
    print_errors(direction);
    std::printf(" %.6f\n", std::sqrt(stated / double(visibility.size())));
    return true;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc < 3) {
        std::fprintf(stderr, "usage: map_error TRUTH.exr MAP.exr ...\n");
        return 2;
    }
    ImageBuf truth(argv[1]);
    if (!truth.read(0, 0, true, OIIO::TypeDesc::FLOAT) || Channels(truth.spec()).coverage < 0) {
        std::fprintf(stderr, "map_error: \"%s\" is no map with the channel coverage\n", argv[1]);
        return 1;
    }
    for (int i = 2; i < argc; ++i)
        if (!compare(truth, argv[i]))
            return 1;
    return 0;
}
