// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/background.h>

#include <vmlight/base/parallel.h>
#include <vmlight/cfem/environment.h>
#include <vmlight/image/channels.h>
#include <vmlight/math/latlong.h>

#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace vmlight {
namespace {

using Imath::C3f;
using Imath::V2d;
using Imath::V3d;

// A lat-long image of R, G, B, all of its display window.
struct Panorama
{
    int width, height;
    std::vector<float> pixels;
};

bool read_panorama(Panorama& dst, const OIIO::ImageBuf& image, std::string& error)
{
    const Environment environment(image);
    std::array<int, 3> index;
    error = environment.fault();
    if (!error.empty() || !find_color_channels(image.spec(), index, error))
        return false;
    const OIIO::ImageSpec& spec = image.spec();
    dst.width = spec.full_width;
    dst.height = spec.full_height;
    dst.pixels.resize(size_t(dst.width) * size_t(dst.height) * 3);
    std::vector<float> row(size_t(dst.width) * size_t(spec.nchannels));
    for (int y = 0; y < dst.height; ++y) {
        const OIIO::ROI roi(spec.full_x, spec.full_x + dst.width, spec.full_y + y, spec.full_y + y + 1, 0, 1, 0,
                            spec.nchannels);
        if (!environment.read(roi, row.data(), error))
            return false;
        for (int x = 0; x < dst.width; ++x)
            for (int c = 0; c < 3; ++c)
                dst.pixels[(size_t(y) * size_t(dst.width) + size_t(x)) * 3 + size_t(c)]
                    = row[size_t(x) * size_t(spec.nchannels) + size_t(index[c])];
    }
    return true;
}

// Means of blocks of `step` x `step` pixels, which divide the map, weighted by solid angle.
Panorama reduced(const Panorama& map, int step)
{
    Panorama result { map.width / step, map.height / step, {} };
    result.pixels.resize(size_t(result.width) * size_t(result.height) * 3);
    for (int y = 0; y < result.height; ++y)
        for (int x = 0; x < result.width; ++x) {
            std::array<double, 3> sum {};
            double total = 0;
            for (int j = 0; j < step; ++j) {
                const double weight = latlong::row_solid_angle(y * step + j, map.height);
                total += weight * step;
                for (int i = 0; i < step; ++i)
                    for (int c = 0; c < 3; ++c)
                        sum[c] += weight
                            * double(map.pixels[(size_t(y * step + j) * size_t(map.width) + size_t(x * step + i)) * 3
                                                + size_t(c)]);
            }
            for (int c = 0; c < 3; ++c)
                result.pixels[(size_t(y) * size_t(result.width) + size_t(x)) * 3 + size_t(c)] = float(sum[c] / total);
        }
    return result;
}

// Every pixel is the mean of those around it, weighted by a Gaussian of the angle between them.
Panorama blurred(const Panorama& map, double sigma, int nthreads)
{
    Panorama result = map;
    const double cutoff = std::cos(std::min(3 * sigma, latlong::pi));
    std::vector<V3d> directions(size_t(map.width) * size_t(map.height));
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x)
            directions[size_t(y) * size_t(map.width) + size_t(x)]
                = latlong::direction((x + 0.5) / map.width, (y + 0.5) / map.height);
    parallel_items(map.height, nthreads, [&](int64_t y, int) {
        const int reach = int(std::ceil(3 * sigma / latlong::pi * map.height));
        // How many pixels of a row to either side are near enough, or half of them all.
        const auto columns = [&](int row) {
            const double nearest = std::min(std::sin((row + 0.5) * latlong::pi / map.height),
                                            std::sin((double(y) + 0.5) * latlong::pi / map.height));
            const double wide = std::ceil(reach / std::max(nearest, 1e-6) * 1.6) + 1;
            return int(std::min(wide, double(map.width / 2)));
        };
        for (int x = 0; x < map.width; ++x) {
            const V3d& here = directions[size_t(y) * size_t(map.width) + size_t(x)];
            std::array<double, 3> sum {};
            double total = 0;
            for (int j = std::max(0, int(y) - reach); j <= std::min(map.height - 1, int(y) + reach); ++j)
                for (int k = -columns(j); k <= columns(j) && k < map.width - columns(j); ++k) {
                    const size_t at = size_t(j) * size_t(map.width) + size_t((x + k + map.width) % map.width);
                    const double cosine = here.dot(directions[at]);
                    if (cosine < cutoff)
                        continue;
                    const double angle = std::acos(std::min(cosine, 1.0)) / sigma;
                    const double weight = std::exp(-0.5 * angle * angle) * latlong::row_solid_angle(j, map.height);
                    total += weight;
                    for (int c = 0; c < 3; ++c)
                        sum[c] += weight * double(map.pixels[at * 3 + size_t(c)]);
                }
            for (int c = 0; c < 3; ++c)
                result.pixels[(size_t(y) * size_t(map.width) + size_t(x)) * 3 + size_t(c)] = float(sum[c] / total);
        }
    });
    return result;
}

} // namespace

C3f Background::look(const CameraRay& ray) const
{
    if (!environment)
        return color;
    const auto position = [&](const V3d& direction) { return latlong::position(rotate(rotation, direction)); };
    TextureFootprint at;
    at.st = position(ray.direction);
    const auto step = [&](const V3d& change) {
        V2d d = position(ray.direction + change) - at.st;
        d.x -= std::round(d.x); // across the seam
        return d;
    };
    at.dx = step(ray.direction_dx);
    at.dy = step(ray.direction_dy);
    C3f seen;
    environment->lookup(at, &seen.x);
    return seen;
}

bool make_background(std::shared_ptr<const TexturePyramid>& dst, const OIIO::ImageBuf& environment, double blur,
                     int nthreads, std::string& error)
{
    Panorama map;
    if (!read_panorama(map, environment, error))
        return false;
    if (blur > 0) {
        const double sigma = blur * latlong::pi / 180;
        // Half the deviation is fine enough for what a blur leaves, and keeps small blurs of large maps quick.
        int step = 1;
        while (map.height / (2 * step) >= 8 && map.width % (2 * step) == 0 && map.height % (2 * step) == 0
               && latlong::pi / map.height * (2 * step) <= sigma / 2)
            step *= 2;
        map = blurred(reduced(map, step), sigma, nthreads);
    }
    dst = std::make_shared<TexturePyramid>(map.width, map.height, 3, map.pixels.data(), nullptr, TextureWrap::periodic,
                                           TextureWrap::clamp, nthreads);
    return true;
}

} // namespace vmlight
