// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/cell_light.h>

#include <vmlight/cfem/radiance.h>
#include <vmlight/lightmap/brightest_light.h>
#include <vmlight/lightmap/cfem_lookup.h>
#include <vmlight/math/latlong.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vmlight {

using namespace direction_grid;
using Imath::V3d;
using latlong::pi;

namespace {

using Moments = std::array<double, kMomentFloats>;
using Grid = std::vector<Moments>; // kColumns times kSlices

// The share of [middle - half, middle + half], in units of cells, that is in cell `k`.
double share(double middle, double half, int k)
{
    return std::max(0.0, std::min(middle + half, k + 1.0) - std::max(middle - half, double(k))) / (2 * half);
}

// Add a patch `size` radians wide around `w`. Near the poles of the grid it wraps around.
void add_patch(Grid& grid, const V3d& w, double size, const double* color, double solid_angle)
{
    const double across = std::hypot(w.x, w.z);
    const double column = latlong::position(w).x * kColumns;
    const double half_column = std::min(0.5, 0.25 * size / pi / std::max(across, 1e-9)) * kColumns;
    const double half_slice = std::min(0.5, 0.25 * size * std::max(across, 0.5 * size)) * kSlices;
    // Moved inside where it would reach beyond the pole.
    const double slice = std::clamp((w.y + 1) * 0.5 * kSlices, half_slice, kSlices - half_slice);
    const int first = std::max(0, int(slice - half_slice)), last = std::min(kSlices - 1, int(slice + half_slice));
    for (int c = int(std::floor(column - half_column)); c < column + half_column; ++c) {
        const double part = solid_angle * share(column, half_column, c);
        Moments* cells = &grid[size_t((c % kColumns + kColumns) % kColumns * kSlices)];
        for (int s = first; s <= last && part > 0; ++s) {
            const double weight = part * share(slice, half_slice, s);
            for (int k = 0; k < 4; ++k) {
                for (int axis = 0; axis < 3; ++axis)
                    cells[s][size_t(4 * axis + k)] += weight * w[axis] * color[k];
                cells[s][size_t(12 + k)] += weight * color[k];
            }
        }
    }
}

void set_triples(CellLight& dst)
{
    const auto band = [&](int cell, int k) {
        const int column = cell % kColumns, edge = cell / kColumns * kSlicesPerBand;
        const float* at = &dst.running[size_t(column * (kSlices + 1) + edge) * kMomentFloats + size_t(k)];
        return at[kSlicesPerBand * kMomentFloats] - at[0];
    };
    dst.triples.resize(size_t(kTriples) * kTripleCodes * kMomentFloats);
    float* sum = dst.triples.data();
    for (int triple = 0; triple < kTriples; ++triple)
        for (int code = 0; code < kTripleCodes; ++code)
            for (int k = 0; k < kMomentFloats; ++k)
                *sum++ = float(code >> 4) * band(3 * triple, k) + float(code >> 2 & 3) * band(3 * triple + 1, k)
                    + float(code & 3) * band(3 * triple + 2, k);
}

// How pixels are cut into nearly square patches, at most a cell high.
struct Parts
{
    int across, down; // of a pixel
};

Parts parts_of(const CfemLookup& map)
{
    constexpr int kLeastRows = 64, kMostRows = 512;
    const int rows = std::clamp(map.width / 2, kLeastRows, kMostRows);
    const int down = std::max(1, (rows + map.height - 1) / map.height);
    return { std::max(1, (2 * map.height * down + map.width - 1) / map.width), down };
}

void measure(CellLight& dst, const CfemLookup& map)
{
    for (int c = 0; c < 3; ++c) {
        double mean = 0;
        float least = map.at(0, 0)[c], most = least;
        for (int y = 0; y < map.height; ++y)
            for (int x = 0; x < map.width; ++x) {
                const float value = map.at(x, y)[c];
                mean += double(value) * latlong::row_solid_angle(y, map.height) / (4 * pi * map.width);
                least = std::min(least, value);
                most = std::max(most, value);
            }
        // A constant is its own mean, to the last bit.
        dst.mean[c] = std::clamp(float(mean), least, most);
        dst.least[c] = least;
        dst.most[c] = most;
    }
}

} // namespace

bool build_cell_light(CellLight& dst, const OIIO::ImageBuf& radiance, const Rotation& to_object, bool triples,
                      std::string& error)
{
    constexpr int kMostWidth = 256;
    OIIO::ImageBuf reduced;
    CfemParams small;
    small.resolution = { kMostWidth, kMostWidth / 2 };
    const bool large = radiance.spec().width > kMostWidth || radiance.spec().height > kMostWidth / 2;
    CfemLookup map;
    if ((large && !make_radiance(reduced, radiance, small, error))
        || !prepare_cfem(map, large ? reduced : radiance, error))
        return false;
    measure(dst, map);
    find_brightest_light(dst.brightest, large ? reduced : radiance);

    Grid grid(size_t(kColumns) * kSlices, Moments {});
    const Parts parts = parts_of(map);
    const int width = map.width * parts.across, height = map.height * parts.down;
    const double size = pi / height;
    for (int y = 0; y < height; ++y) {
        const double solid_angle = latlong::row_solid_angle(y, height) / width;
        for (int x = 0; x < width; ++x) {
            const V3d w = rotate(to_object, latlong::direction((x + 0.5) / width, (y + 0.5) / height));
            const float* rgb = map.at(x / parts.across, y / parts.down);
            const double color[4] = { double(rgb[0]) - double(dst.mean[0]), double(rgb[1]) - double(dst.mean[1]),
                                      double(rgb[2]) - double(dst.mean[2]), 1 };
            add_patch(grid, w, size, color, solid_angle);
        }
    }
    dst.running.assign(size_t(kColumns) * (kSlices + 1) * kMomentFloats, 0.0f);
    float* running = dst.running.data() + kMomentFloats;
    for (int column = 0; column < kColumns; ++column, running += kMomentFloats) {
        Moments sum {};
        for (int slice = 0; slice < kSlices; ++slice)
            for (int k = 0; k < kMomentFloats; ++k)
                *running++ = float(sum[size_t(k)] += grid[size_t(column * kSlices + slice)][size_t(k)]);
    }
    dst.triples.clear();
    if (triples)
        set_triples(dst);
    return true;
}

} // namespace vmlight
