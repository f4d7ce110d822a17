// SPDX-License-Identifier: Apache-2.0
#include <vmlight/uv/unwrap_chart.h>

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <complex>

namespace vmlight {

using Imath::V2d;
using Imath::V3d;

namespace {

using Complex = std::complex<double>;
using Matrix = Eigen::SparseMatrix<Complex>;

// The vertices of the border that are (nearly) farthest apart: they are held in place.
std::pair<uint32_t, uint32_t> choose_pins(const UnwrapChart& chart, const UnwrapSurface& surface)
{
    const auto farthest_from = [&](const V3d& from) {
        uint32_t best = chart.from(chart.border[0]);
        double most = -1;
        for (uint32_t h : chart.border) {
            const double distance = (surface.position(chart.points[chart.from(h)]) - from).length2();
            if (distance > most) {
                most = distance;
                best = chart.from(h);
            }
        }
        return best;
    };
    const uint32_t start = chart.from(chart.border[0]);
    const uint32_t a = farthest_from(surface.position(chart.points[start]));
    return { a, farthest_from(surface.position(chart.points[a])) };
}

// The corners of a triangle in its own plane. One thinner than this would make the equations singular: it is taken to
// be as thick.
std::array<Complex, 3> in_own_plane(const UnwrapSurface& surface, uint32_t t)
{
    constexpr double kThinnest = 1e-4;
    const std::array<Imath::V2d, 3> flat = surface.flat_corners(t);
    const double length = std::max({ flat[0].x, flat[1].x, flat[2].x });
    std::array<Complex, 3> corners;
    for (size_t k = 0; k < 3; ++k)
        corners[k] = { flat[k].x, flat[k].y > 0 ? std::max(flat[k].y, kThinnest * length) : 0 };
    return corners;
}

} // namespace

bool map_conformally(UnwrapChart& chart, const UnwrapSurface& surface)
{
    const auto [pin0, pin1] = choose_pins(chart, surface);
    if (pin0 == pin1)
        return false;
    const double length = (surface.position(chart.points[pin1]) - surface.position(chart.points[pin0])).length();
    if (!(length > 0))
        return false;
    // The numbers of the free vertices; the pins are last.
    const int count = int(chart.points.size()), free = count - 2;
    std::vector<int> numbers(size_t(count), 0);
    for (int i = 0, next = 0; i < count; ++i)
        numbers[size_t(i)] = uint32_t(i) == pin0 ? free : uint32_t(i) == pin1 ? free + 1 : next++;

    std::vector<Eigen::Triplet<Complex>> entries;
    Eigen::VectorXcd right = Eigen::VectorXcd::Zero(free);
    const Complex held[2] = { 0, length };
    for (size_t i = 0; i < chart.triangles.size(); ++i) {
        const std::array<Complex, 3> p = in_own_plane(surface, chart.triangles[i]);
        const double doubled = std::imag(std::conj(p[1] - p[0]) * (p[2] - p[0]));
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k) {
                const int row = numbers[chart.corners[i][j]], column = numbers[chart.corners[i][k]];
                if (row >= free)
                    continue;
                const Complex a = p[(j + 2) % 3] - p[(j + 1) % 3], b = p[(k + 2) % 3] - p[(k + 1) % 3];
                const Complex entry = std::conj(a) * b / doubled;
                if (column < free)
                    entries.emplace_back(row, column, entry);
                else
                    right[row] -= entry * held[column - free];
            }
    }
    if (free > 0) {
        Matrix matrix(free, free);
        matrix.setFromTriplets(entries.begin(), entries.end());
        const Eigen::SimplicialLDLT<Matrix> solver(matrix);
        if (solver.info() != Eigen::Success)
            return false;
        right = solver.solve(right).eval();
        if (!right.allFinite())
            return false;
    }
    chart.uvs.resize(size_t(count));
    for (int i = 0; i < count; ++i) {
        const int number = numbers[size_t(i)];
        const Complex uv = number < free ? right[number] : held[number - free];
        chart.uvs[size_t(i)] = { uv.real(), uv.imag() };
    }
    return true;
}

} // namespace vmlight
