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

using Grid = std::vector<CellMoments>; // kColumns times kSlices

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
        CellMoments* cells = &grid[size_t((c % kColumns + kColumns) % kColumns * kSlices)];
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

// Running sums over the slices of a column: kSlices + 1 edges.
std::vector<CellMoments> running_sums(const Grid& grid, int column)
{
    std::vector<CellMoments> sums(kSlices + 1, CellMoments {});
    for (int slice = 0; slice < kSlices; ++slice)
        for (size_t k = 0; k < sums[0].size(); ++k)
            sums[size_t(slice) + 1][k] = sums[size_t(slice)][k] + grid[size_t(column * kSlices + slice)][k];
    return sums;
}

// The moments of cells, band by band.
std::vector<CellMoments> band_sums(const Grid& grid)
{
    std::vector<CellMoments> cells(kCells, CellMoments {});
    for (int cell = 0; cell < kCells; ++cell)
        for (int slice = 0; slice < kSlicesPerBand; ++slice) {
            const size_t from = size_t(cell % kColumns * kSlices + cell / kColumns * kSlicesPerBand + slice);
            for (size_t k = 0; k < cells[0].size(); ++k)
                cells[size_t(cell)][k] += grid[from][k];
        }
    return cells;
}

// Sums of `grid`, each at most `largest` times, must fit the fixed point.
void set_units(CellLight& dst, double* per_unit, const Grid& grid, double largest)
{
    for (int lane = 0; lane < kMomentLanes; ++lane) {
        double most = 0;
        for (int axis = 0; axis < 3; ++axis) {
            double sum = 0;
            for (const CellMoments& cell : grid)
                sum += std::abs(cell[size_t(4 * axis + lane)]);
            most = std::max(most, sum);
        }
        per_unit[lane] = most > 0 ? (kMomentBias - kMomentSlack) / (most * largest) : 0;
        dst.unit[lane] = float(most > 0 ? 1 / per_unit[lane] : 0);
    }
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

void measure(EnvironmentBounds& dst, const CfemLookup& map)
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

bool bin_environment(std::vector<CellMoments>& cells, EnvironmentBounds& bounds, const OIIO::ImageBuf& radiance,
                     const Rotation& to_object, std::string& error)
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
    measure(bounds, map);
    find_brightest_light(bounds.brightest, large ? reduced : radiance);

    cells.assign(size_t(kColumns) * kSlices, CellMoments {});
    const Parts parts = parts_of(map);
    const int width = map.width * parts.across, height = map.height * parts.down;
    const double size = pi / height;
    for (int y = 0; y < height; ++y) {
        const double solid_angle = latlong::row_solid_angle(y, height) / width;
        for (int x = 0; x < width; ++x) {
            const V3d w = rotate(to_object, latlong::direction((x + 0.5) / width, (y + 0.5) / height));
            const float* rgb = map.at(x / parts.across, y / parts.down);
            const double color[4] = { double(rgb[0]) - double(bounds.mean[0]), double(rgb[1]) - double(bounds.mean[1]),
                                      double(rgb[2]) - double(bounds.mean[2]), 1 };
            add_patch(cells, w, size, color, solid_angle);
        }
    }
    return true;
}

bool build_mask_light(CellLight& dst, const OIIO::ImageBuf& radiance, const Rotation& to_object, std::string& error)
{
    constexpr int kEdges = kSlices + 1, kDensities = kMaskCodes / kEdges;
    Grid grid;
    double per_unit[kMomentLanes];
    if (!bin_environment(grid, dst, radiance, to_object, error))
        return false;
    set_units(dst, per_unit, grid, kDensities - 1);
    dst.moments.assign(size_t(kColumns) * kMaskStride, {});
    dst.plain.assign(size_t(kColumns) * kEdges * 4, 0.0f);
    for (int column = 0; column < kColumns; ++column) {
        const std::vector<CellMoments> sums = running_sums(grid, column);
        PackedMoments* entry = &dst.moments[size_t(column) * kMaskStride];
        for (int edge = 0; edge < kEdges; ++edge) {
            for (int density = 0; density < kDensities; ++density) {
                CellMoments part;
                for (size_t k = 0; k < part.size(); ++k)
                    part[k] = density * sums[size_t(edge)][k];
                *entry++ = pack_moments(part.data(), per_unit);
            }
            for (size_t c = 0; c < 3; ++c)
                dst.plain[size_t(column * kEdges + edge) * 4 + c] = float(sums[size_t(edge)][12 + c]);
        }
    }
    return true;
}

bool build_cells_light(CellLight& dst, const OIIO::ImageBuf& radiance, const Rotation& to_object, std::string& error)
{
    Grid grid;
    double per_unit[kMomentLanes];
    if (!bin_environment(grid, dst, radiance, to_object, error))
        return false;
    set_units(dst, per_unit, grid, 3);
    const std::vector<CellMoments> cells = band_sums(grid);
    dst.moments.assign(size_t(kCellsParts) * kCellsStride, {});
    for (int part = 0; part < kCellsParts; ++part)
        for (int code = 0; code < kCellsCodes; ++code) {
            CellMoments sum {};
            for (int cell = 0; cell < 4; ++cell)
                for (size_t k = 0; k < 12; ++k)
                    sum[k] += (code >> (6 - 2 * cell) & 3) * cells[size_t(4 * part + cell)][k];
            dst.moments[size_t(part * kCellsStride + code)] = pack_moments(sum.data(), per_unit);
        }
    dst.plain.assign(size_t(kTriples) * kTripleCodes * 4, 0.0f);
    for (int triple = 0; triple < kTriples; ++triple)
        for (int code = 0; code < kTripleCodes; ++code)
            for (size_t c = 0; c < 3; ++c) {
                double sum = 0;
                for (int cell = 0; cell < 3; ++cell)
                    sum += (code >> (4 - 2 * cell) & 3) * cells[size_t(3 * triple + cell)][12 + c];
                dst.plain[size_t(triple * kTripleCodes + code) * 4 + c] = float(sum);
            }
    return true;
}

} // namespace vmlight
