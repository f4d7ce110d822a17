// SPDX-License-Identifier: Apache-2.0
#include <vmlight/uv/unwrap_pack.h>

#include <vmlight/base/parallel.h>
#include <vmlight/uv/unwrap_bounds.h>
#include <vmlight/uv/unwrap_grid.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace vmlight {

using Imath::V2d;

namespace {

// What a rasterizer that rounds, and the steps of the UVs, may add to a chart, in texels.
constexpr double kRounding = 1.0 / 128;
// Each chart is a point, in cells per unit.
constexpr double kLeastScale = 1e-9;

// The cells that a triangle touches.
void touch(UnwrapBitmap& dst, const std::array<V2d, 3>& corners, double rounding)
{
    const auto cell = [](double x, int count) { return std::clamp(int(std::floor(x)), 0, count - 1); };
    const auto [low, high] = std::minmax({ corners[0].y, corners[1].y, corners[2].y });
    const int last = cell(high + rounding, dst.height());
    for (int y = cell(low - rounding, dst.height()); y <= last; ++y) {
        const double bottom = y - rounding, top = y + 1 + rounding;
        double left = 1e300, right = -1e300;
        const auto reach = [&](double x) {
            left = std::min(left, x);
            right = std::max(right, x);
        };
        for (int k = 0; k < 3; ++k) {
            const V2d &a = corners[size_t(k)], &b = corners[size_t(k + 1) % 3];
            if (a.y >= bottom && a.y <= top)
                reach(a.x);
            for (double level : { bottom, top })
                if ((a.y < level) != (b.y < level))
                    reach(a.x + (b.x - a.x) * ((level - a.y) / (b.y - a.y)));
        }
        if (left <= right)
            dst.set(cell(left - rounding, dst.width()), cell(right + rounding, dst.width()), y);
    }
}

// A chart at one scale.
struct Piece
{
    double scale = 0; // cells per unit
    V2d offset { 0, 0 }; // in cells, from the chart's own origin
    std::vector<UnwrapShape> turns; // by quarters
    int x = 0, y = 0, turn = 0;

    V2d placed(const V2d& uv) const
    {
        V2d p = uv * scale + offset;
        int width = turns[0].width, height = turns[0].height;
        for (int quarter = 0; quarter < turn; ++quarter) {
            p = { height - p.y, p.x };
            std::swap(width, height);
        }
        return p + V2d(x, y);
    }
};

class Packer
{
public:
    Packer(std::vector<UnwrapChart>& charts, const UnwrapParams& params)
        : m_charts(charts)
        , m_nthreads(params.nthreads)
        , m_gap(unwrap_gap(params))
        , m_order(charts.size())
    {
        // Cells as coarse as gap and map allow, and no finer than 1024 for the longest side.
        constexpr int kGapCells = 8, kLeastCells = 256, kMostCells = 1024;
        const int longest = std::max(params.width, params.height), shortest = std::min(params.width, params.height);
        m_cell = std::max(
            { 1, std::min(m_gap / kGapCells, shortest / kLeastCells), (longest + kMostCells - 1) / kMostCells });
        // At the outer border a texel stays free, so that interpolated lookups that wrap around find no other chart.
        m_border = std::min(params.width, params.height) >= 64 ? 1 : 0;
        m_width = std::max(1, (params.width - 2 * m_border) / m_cell);
        m_height = std::max(1, (params.height - 2 * m_border) / m_cell);
        std::vector<V2d> sizes;
        for (UnwrapChart& chart : charts) {
            sizes.push_back(lay_straight(chart));
            m_area += chart.area;
        }
        std::iota(m_order.begin(), m_order.end(), 0u);
        std::stable_sort(m_order.begin(), m_order.end(),
                         [&](uint32_t a, uint32_t b) { return sizes[a].x * sizes[a].y > sizes[b].x * sizes[b].y; });
    }

    bool run()
    {
        // From what would be full, gaps included, down to where it fits; then between the two.
        double high = scale_for(1.0), low = 0;
        std::vector<Piece> best;
        for (double share = 0.85; share > 0.01 && best.empty(); share *= 0.85)
            if (low = scale_for(share); !place_all(best, low))
                high = low;
        if (best.empty() && !place_all(best, low = kLeastScale))
            return false;
        constexpr double kPrecision = 0.005;
        while (high - low > kPrecision * high) {
            const double middle = (low + high) / 2;
            std::vector<Piece> pieces;
            if (place_all(pieces, middle)) {
                low = middle;
                best = std::move(pieces);
            } else {
                high = middle;
            }
        }
        m_density = low * m_cell;
        for (size_t c = 0; c < m_charts.size(); ++c)
            for (V2d& uv : m_charts[c].uvs)
                uv = best[c].placed(uv) * double(m_cell) + V2d(m_border, m_border);
        return true;
    }

    double density() const { return m_density; }

private:
    // Cells per unit, so that the charts, as if they were square, and their gaps take a share of the map.
    double scale_for(double share) const
    {
        const double gap = double(m_gap) / m_cell;
        const auto taken = [&](double scale) {
            double sum = 0;
            for (const UnwrapChart& chart : m_charts) {
                const double side = std::sqrt(chart.area) * scale + gap;
                sum += side * side;
            }
            return sum;
        };
        double low = 0, high = std::sqrt(double(m_width) * m_height / m_area);
        const double wanted = share * (m_width + gap) * (m_height + gap);
        for (int step = 0; step < 40; ++step)
            (taken((low + high) / 2) < wanted ? low : high) = (low + high) / 2;
        return std::max(low, kLeastScale);
    }

    Piece make_piece(const UnwrapChart& chart, double scale) const
    {
        Piece piece;
        piece.scale = scale;
        const double rounding = kRounding / m_cell;
        UvBounds bounds;
        for (const V2d& uv : chart.uvs)
            bounds.add(uv * scale);
        // A chart of a few texels lies so that it covers the centre of one.
        V2d shift(0, 0);
        if (std::min(bounds.size().x, bounds.size().y) * m_cell < 8) {
            const V2d centre = (largest_centre(chart) * scale + V2d(rounding, rounding)) * double(m_cell);
            const auto up_to_centre = [](double x) { return std::ceil(x - 0.5) + 0.5 - x; };
            shift = V2d(up_to_centre(centre.x), up_to_centre(centre.y)) / m_cell;
        }
        piece.offset = V2d(rounding, rounding) + shift;
        const V2d end = bounds.high + piece.offset + V2d(rounding, rounding);
        UnwrapBitmap bitmap(std::max(1, int(std::ceil(end.x))), std::max(1, int(std::ceil(end.y))));
        if (bitmap.width() > std::max(m_width, m_height) || bitmap.height() > std::max(m_width, m_height))
            return piece;
        for (const auto& c : chart.corners) {
            std::array<V2d, 3> corners;
            for (int k = 0; k < 3; ++k)
                corners[size_t(k)] = chart.uvs[c[k]] * scale + piece.offset;
            touch(bitmap, corners, rounding);
        }
        for (int turn = 0; turn < 4; ++turn) {
            piece.turns.emplace_back(bitmap);
            bitmap = bitmap.turned();
        }
        return piece;
    }

    static V2d largest_centre(const UnwrapChart& chart)
    {
        V2d centre(0, 0);
        double most = -1;
        for (const auto& c : chart.corners) {
            const V2d &a = chart.uvs[c[0]], &b = chart.uvs[c[1]], &d = chart.uvs[c[2]];
            if ((b - a).cross(d - a) > most) {
                most = (b - a).cross(d - a);
                centre = (a + b + d) / 3;
            }
        }
        return centre;
    }

    bool place_all(std::vector<Piece>& dst, double scale) const
    {
        std::vector<Piece> pieces(m_charts.size());
        parallel_items(int64_t(pieces.size()), m_nthreads,
                       [&](int64_t c, int) { pieces[size_t(c)] = make_piece(m_charts[size_t(c)], scale); });
        const int gap = (m_gap + m_cell - 1) / m_cell;
        UnwrapGrid grid(m_width, m_height);
        for (uint32_t c : m_order) {
            Piece& piece = pieces[c];
            int top = m_height + 1;
            for (int turn = 0; turn < int(piece.turns.size()); ++turn) {
                const UnwrapShape& shape = piece.turns[size_t(turn)];
                int x = 0, y = 0;
                if (grid.find_place(shape, top - shape.height - 1, x, y)) {
                    piece.x = x, piece.y = y, piece.turn = turn;
                    top = y + shape.height;
                }
            }
            if (top > m_height)
                return false;
            grid.take(piece.turns[size_t(piece.turn)], piece.x, piece.y, gap);
        }
        dst = std::move(pieces);
        return true;
    }

    std::vector<UnwrapChart>& m_charts;
    const int m_nthreads, m_gap;
    int m_cell, m_border, m_width, m_height; // width and height in cells
    double m_area = 0, m_density = 0;
    std::vector<uint32_t> m_order;
};

} // namespace

int unwrap_gap(const UnwrapParams& params)
{
    constexpr int kGapOfFullMap = 16;
    return params.margin < 0 ? kGapOfFullMap : std::max(1, params.margin);
}

bool pack_charts(std::vector<UnwrapChart>& charts, const UnwrapParams& params, double& density)
{
    Packer packer(charts, params);
    if (!packer.run())
        return false;
    density = packer.density();
    return true;
}

} // namespace vmlight
