// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cell_light.h>

#include <vmlight/cfem_lookup.h>
#include <vmlight/latlong.h>

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

// The part of [middle - half, middle + half], in units of cells, that lies in cell `k`.
double share(double middle, double half, int k)
{
    return std::max(0.0, std::min(middle + half, k + 1.0) - std::max(middle - half, double(k))) / (2 * half);
}

// Of a patch `size` radians wide around `w`. Near the poles of the grid it reaches around the sphere.
void add_patch(Grid& grid, const V3d& w, double size, const double* color, double solid_angle)
{
    const double across = std::hypot(w.x, w.z);
    const double column = latlong::position(w).x * kColumns;
    const double half_column = std::min(0.5, 0.25 * size / pi / std::max(across, 1e-9)) * kColumns;
    const double half_slice = std::min(0.5, 0.25 * size * std::max(across, 0.5 * size)) * kSlices;
    // Moved inside where it would stick out of the sphere.
    const double slice = std::clamp((w.y + 1) * 0.5 * kSlices, half_slice, kSlices - half_slice);
    const int first = std::max(0, int(slice - half_slice)), last = std::min(kSlices - 1, int(slice + half_slice));
    for (int c = int(std::floor(column - half_column)); c < column + half_column; ++c) {
        const double part = solid_angle * share(column, half_column, c);
        Moments* cells = &grid[size_t((c % kColumns + kColumns) % kColumns * kSlices)];
        for (int s = first; s <= last && part > 0; ++s) {
            const double weight = part * share(slice, half_slice, s);
            for (int axis = 0; axis < 3; ++axis)
                for (int k = 0; k < 4; ++k)
                    cells[s][size_t(4 * axis + k)] += weight * w[axis] * color[k];
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

} // namespace

bool prepare_cells(CellLight& dst, const OIIO::ImageBuf& radiance, const Rotation& to_object, bool triples,
                   std::string& error)
{
    CfemLookup map;
    if (!prepare_cfem(map, radiance, error))
        return false;
    const auto pixel
        = [&](int x, int y) { return &map.texels[4 * (size_t(y + 1) * size_t(map.pitch) + size_t(x + 1))]; };
    double mean[3] = {};
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x)
            for (int c = 0; c < 3; ++c)
                mean[c] += pixel(x, y)[c] * latlong::row_solid_angle(y, map.height) / (4 * pi * map.width);
    // What is the same everywhere is its own mean, to the last bit.
    for (int c = 0; c < 3; ++c) {
        dst.mean[c] = float(mean[c]);
        bool constant = true;
        for (int y = 0; y < map.height && constant; ++y)
            for (int x = 0; x < map.width; ++x)
                constant &= pixel(x, y)[c] == pixel(0, 0)[c];
        if (constant)
            dst.mean[c] = pixel(0, 0)[c];
    }

    Grid grid(size_t(kColumns) * kSlices, Moments {});
    const double size = pi / map.height;
    for (int y = 0; y < map.height; ++y) {
        const double solid_angle = latlong::row_solid_angle(y, map.height) / map.width;
        for (int x = 0; x < map.width; ++x) {
            const V3d w = rotate(to_object, latlong::direction((x + 0.5) / map.width, (y + 0.5) / map.height));
            const float* rgb = pixel(x, y);
            const double color[4]
                = { double(rgb[0]) - dst.mean[0], double(rgb[1]) - dst.mean[1], double(rgb[2]) - dst.mean[2], 1 };
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
