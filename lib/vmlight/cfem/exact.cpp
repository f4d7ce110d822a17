// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cfem/exact.h>

#include <vmlight/base/parallel.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/cfem/kernel.h>
#include <vmlight/cfem/prefix.h>
#include <vmlight/math/latlong.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vmlight {

using latlong::pi;

namespace {

constexpr int kBandNodes = 2; // per band
// Rows are split into bands of at most pi / 128, so that the ends of arcs are sampled finely enough, and rows with a
// sun into finer ones. Where the horizon crosses a bright pixel, a band of extent d that has a share of all light in
// one place errs by up to 0.077 d times that share of the mean (measured: bench/cfem_bench.cpp), and N bands in its
// place by N^2 times less.
constexpr double kBandsPerRadian = 128 / pi;
constexpr double kHorizonError = 0.077, kTolerance = 5e-5;
// Bytes of prefix cells per block of rows. More is slower, because of the caches; less is slower because threads
// synchronise twice per block.
constexpr size_t kBlockBytes = size_t(4) << 20;

// A band of latitude within a row of the environment, and its default nodes.
struct Band
{
    int row; // of the block
    double theta0, theta1;
    size_t first_node, last_node;
};

struct ResultRow
{
    double cos_theta, sin_theta;
    // Circles with theta < near are entirely above the horizon of a pixel in the upper half of the result, circles with
    // theta > far entirely below; for the lower half, vice versa.
    double near, far;
    Moments all; // of all circles, visible or not
    double unit = 0; // the same sums for L = 1: the visible part ...
    double unit_vertical = 0; // ... and the vertical moment of all
};

// Memory of one worker for one row of the result.
struct Scratch
{
    std::vector<ColumnSum> sums;
    // Whole circles, in columns from here on: the difference of neighbouring columns, to be summed.
    std::vector<Moments> circles;
    std::vector<LatitudeNode> nodes;
};

class ExactFilter
{
public:
    ExactFilter(std::vector<double>& rgb, const Size& resolution, const EnvironmentGrid& grid, int nthreads,
                HemisphereWeight weight)
        : m_rgb(rgb)
        , m_uniform(weight == HemisphereWeight::uniform)
        , m_width(resolution.width)
        , m_height(resolution.height)
        , m_grid(grid)
        , m_nthreads(nthreads)
        , m_rule(kBandNodes)
        , m_stride(size_t(grid.width) + 2)
        , m_block_rows(int(std::clamp<size_t>(kBlockBytes / (m_stride * sizeof(PrefixCell)), 4, 64)))
        // The antipode of a pixel centre is a pixel centre only if the width is even.
        , m_mirrored(m_width % 2 == 0)
        , m_computed_rows(m_mirrored ? (m_height + 1) / 2 : m_height)
    {
        m_rgb.assign(size_t(3) * m_width * m_height, 0.0);
        m_cells.resize(m_stride * m_block_rows);
        m_light.resize(m_block_rows);
        m_pixels.resize(size_t(3) * grid.width * m_block_rows);
        m_scratch.resize(worker_count(nthreads));
        for (int i = 0; i <= grid.width; ++i) {
            const double phi = grid.column_edge(i);
            m_edges.push_back({ phi, i == grid.width ? 1 : std::cos(phi), i == grid.width ? 0 : std::sin(phi) });
        }
        for (int c = 0; c < m_width; ++c) {
            const double phi = 2 * pi * (c + 0.5) / m_width;
            m_columns.push_back({ phi, std::cos(phi), std::sin(phi) });
        }
        for (int r = 0; r < m_computed_rows; ++r) {
            const double theta = pi * (r + 0.5) / m_height, near = std::abs(0.5 * pi - theta);
            m_rows.push_back({ std::cos(theta), std::sin(theta), near, pi - near, {} });
        }
    }

    bool run(const ReadRow& read, const Progress& progress)
    {
        for (int row = 0; row < m_grid.height; row += m_block_rows) {
            const int rows = std::min(m_block_rows, m_grid.height - row);
            for (int r = 0; r < rows; ++r)
                if (!read(row + r, &m_pixels[size_t(3) * m_grid.width * r]))
                    return false;
            parallel_items(rows, m_nthreads, [&](int64_t r, int) {
                m_light[r] = make_prefix(&m_cells[m_stride * r], &m_pixels[size_t(3) * m_grid.width * r], m_edges);
            });
            set_bands(row, rows);
            const auto report = [&](double share) { return progress((row + share * rows) / m_grid.height); };
            if (!parallel_items(
                    m_computed_rows, m_nthreads, [&](int64_t r, int worker) { add_block(int(r), m_scratch[worker]); },
                    progress ? Progress(report) : Progress()))
                return false;
        }
        parallel_items(m_computed_rows, m_nthreads, [&](int64_t r, int) { finish(int(r)); });
        return true;
    }

private:
    void set_bands(int first_row, int rows)
    {
        m_bands.clear();
        m_nodes.clear();
        for (int r = 0; r < rows; ++r) {
            const double theta = m_grid.row_edge(first_row + r);
            const double extent = m_grid.row_edge(first_row + r + 1) - theta;
            const double finer = std::sqrt(kHorizonError / kTolerance * extent
                                           * sun_share(r, std::sin(theta + 0.5 * extent) * extent));
            const int parts = int(std::ceil(std::max({ extent * kBandsPerRadian - 1e-6, finer, 1.0 })));
            for (int part = 0; part < parts; ++part) {
                const size_t first = m_nodes.size();
                const double theta0 = theta + extent * part / parts;
                const double theta1 = theta + extent * (part + 1) / parts;
                m_rule.append(m_nodes, theta0, theta1);
                m_bands.push_back({ r, theta0, theta1, first, m_nodes.size() });
            }
        }
    }

    // The share of the brightest place of the row in all light so far: rows below are not known yet.
    double sun_share(int r, double weight)
    {
        double share = 0;
        for (int k = 0; k < 3; ++k) {
            m_light_so_far[k] += weight * m_light[r].total.zero[k];
            if (m_light_so_far[k] > 0)
                share = std::max(share, weight * m_light[r].brightest[k] / m_light_so_far[k]);
        }
        return share;
    }

    // Add the rows of the block to row `r` of the result.
    void add_block(int r, Scratch& scratch)
    {
        ResultRow& row = m_rows[r];
        scratch.sums.assign(m_width, {});
        scratch.circles.assign(m_width + 1, {});
        for (const Band& band : m_bands) {
            const bool near = band.theta0 < row.near && row.near < band.theta1;
            const bool far = band.theta0 < row.far && row.far < band.theta1;
            if (!near && !far) {
                for (size_t k = band.first_node; k < band.last_node; ++k)
                    add_circle(row, band.row, m_nodes[k], scratch);
                continue;
            }
            // The arc opens or closes within the band, as the power 3/2 of the distance: Gauss quadrature needs an
            // interval that ends there.
            scratch.nodes.clear();
            double from = band.theta0;
            for (double to : { near ? row.near : from, far ? row.far : band.theta1, band.theta1 }) {
                if (to > from)
                    m_rule.append(scratch.nodes, from, to);
                from = std::max(from, to);
            }
            for (const LatitudeNode& node : scratch.nodes)
                add_circle(row, band.row, node, scratch);
        }

        Moments circles;
        double* rgb = &m_rgb[size_t(3) * m_width * r];
        for (int c = 0; c < m_width; ++c, rgb += 3) {
            circles.add(1, 1, scratch.circles[c]);
            for (int k = 0; k < 3; ++k)
                rgb[k] += scratch.sums[c].half[0][k] + scratch.sums[c].half[1][k] + circles.toward(m_columns[c], k);
        }
    }

    void add_circle(ResultRow& row, int block_row, const LatitudeNode& node, Scratch& scratch)
    {
        const double a = node.cos_theta * row.cos_theta, b = node.sin_theta * row.sin_theta;
        const double upward = m_uniform ? node.weight : node.weight * a, sideward = m_uniform ? 0 : node.weight * b;
        const Moments& total = m_light[block_row].total;
        row.all.add(upward, sideward, total);
        row.unit_vertical += 2 * pi * upward;
        if (a <= -b)
            return;
        if (a >= b) {
            scratch.circles[0].add(upward, sideward, total);
            row.unit += 2 * pi * upward;
            return;
        }

        const double reach = std::acos(-a / b), chord = sideward * std::sin(reach);
        row.unit += 2 * (upward * reach + chord);
        // Columns whose arc begins left of the seam, and those whose arc ends right of it.
        const double columns_per_radian = m_width / (2 * pi);
        const int left = std::clamp(int(std::ceil(reach * columns_per_radian - 0.5)), 0, m_width);
        const int right = std::clamp(int(std::ceil((2 * pi - reach) * columns_per_radian - 0.5)), left, m_width);
        scratch.circles[0].add(upward, sideward, total);
        scratch.circles[left].add(-upward, -sideward, total);
        scratch.circles[right].add(upward, sideward, total);

        const double scale = std::ldexp(m_grid.column_scale(), 32), offset = std::ldexp(m_grid.column_offset(), 32);
        const auto add = [&](int first, int last, double end, double start) {
            ArcRun run;
            run.first = first;
            run.last = last;
            run.end[0] = std::llrint((m_columns[0].phi + end) * scale + offset);
            run.end[1] = std::llrint((m_columns[0].phi + start) * scale + offset);
            run.step = std::llrint(2 * pi / m_width * scale);
            run.upward = upward;
            run.sideward = sideward;
            run.slope_at_end[0] = upward * end + chord;
            run.slope_at_end[1] = upward * start - chord;
            if (first < last)
                add_arcs(scratch.sums.data(), &m_cells[m_stride * block_row + 1], m_columns.data(), run);
        };
        add(0, left, reach, 2 * pi - reach);
        add(left, right, reach, -reach);
        add(right, m_width, reach - 2 * pi, -reach);
    }

    // Divide by the result for L = 1, which makes a constant map exact; and fill in the row of the antipodes by
    // max(0, n.w) - max(0, -n.w) = n.w: the sum of -n is that of n less n . Int L w dw, by the same quadrature. Without
    // the cosine, the sums of n and -n add up to the whole sphere, and the difference has the opposite sign.
    void finish(int r)
    {
        const ResultRow& row = m_rows[r];
        const int opposite = m_height - 1 - r, half = m_width / 2;
        const bool mirror = m_mirrored && opposite != r;
        double* rgb = &m_rgb[size_t(3) * m_width * r];
        for (int c = 0; c < m_width; ++c, rgb += 3) {
            double* other = &m_rgb[3 * (size_t(m_width) * opposite + (c + half) % m_width)];
            for (int k = 0; k < 3; ++k) {
                if (mirror)
                    other[k] = (rgb[k] - row.all.toward(m_columns[c], k)) / (row.unit - row.unit_vertical);
                rgb[k] /= row.unit;
            }
        }
    }

    std::vector<double>& m_rgb;
    bool m_uniform;
    int m_width, m_height;
    EnvironmentGrid m_grid;
    int m_nthreads;
    LatitudeRule m_rule;
    size_t m_stride; // prefix cells per row, with a spare one at either end
    int m_block_rows; // depends on the width alone, so that the order of the sums does too
    bool m_mirrored;
    int m_computed_rows;
    std::vector<ColumnAngle> m_edges, m_columns;
    std::vector<ResultRow> m_rows;
    std::vector<float> m_pixels;
    std::vector<PrefixCell> m_cells;
    std::vector<RowLight> m_light;
    std::array<double, 3> m_light_so_far {};
    std::vector<Band> m_bands;
    std::vector<LatitudeNode> m_nodes;
    std::vector<Scratch> m_scratch;
};

} // namespace

bool filter_exact(std::vector<double>& rgb, const Size& resolution, const EnvironmentGrid& grid, const ReadRow& read,
                  int nthreads, const Progress& progress, HemisphereWeight weight)
{
    ++work_counts().filter_passes;
    return ExactFilter(rgb, resolution, grid, nthreads, weight).run(read, progress);
}

} // namespace vmlight
