// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/trimmed_pieces.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace vmlight {
namespace {

using Imath::V2d;
using Imath::V2f;
using Imath::V3d;
using Imath::V3f;

// Of the area of triangles: with less to trim, nothing is.
constexpr double kLargest = 0.9;
// How far edges move outwards, relative to how far away corners and the origins of rays are: 32 times the step of
// floats.
constexpr double kOutwards = 1.9e-6;
// How far the two triangles of a card may be from one plane, likewise; and from a parallelogram, of its edges.
constexpr double kFlat = kOutwards / 4, kSkewed = 0.01;

using Corners = std::array<V3d, 3>;

Corners in_double(const std::array<V3f, 3>& corners)
{
    return { V3d(corners[0]), V3d(corners[1]), V3d(corners[2]) };
}

double reach_of(const Corners& corners)
{
    double reach = 0;
    for (const V3d& corner : corners)
        reach = std::max({ reach, std::abs(corner.x), std::abs(corner.y), std::abs(corner.z) });
    return reach;
}

// Interval of one coordinate.
struct Span
{
    double low, high;

    double size() const { return high - low; }
    void add(const Span& other) { *this = { std::min(low, other.low), std::max(high, other.high) }; }
};

// Corners of a piece, and where they are in its triangle and its partner.
struct Piece
{
    Corners corners;
    std::array<V2d, 3> own, of_partner;
};

TrimmedPiece::Weights weights_of(const std::array<V2d, 3>& at)
{
    const V2f first(at[0]), along_u(at[1] - at[0]), along_v(at[2] - at[0]);
    return { { first.x, along_u.x, along_v.x }, { first.y, along_u.y, along_v.y } };
}

float largest_step(const TrimmedPiece::Weights& weights)
{
    return std::max(std::abs(weights.u[1]) + std::abs(weights.u[2]), std::abs(weights.v[1]) + std::abs(weights.v[2]));
}

void set_piece(TrimmedPiece& dst, std::array<V3f, 3>& corners, const Piece& piece, double reach, uint32_t partner)
{
    const Corners whole = in_double(corners);
    for (size_t k = 0; k < 3; ++k)
        corners[k] = V3f(piece.corners[k]);
    dst.is_trimmed = true;
    dst.partner = partner;
    dst.own = weights_of(piece.own);
    dst.error_scale = largest_step(dst.own);
    if (partner != TrimmedPiece::kAlone) {
        dst.of_partner = weights_of(piece.of_partner);
        dst.error_scale = std::max(dst.error_scale, largest_step(dst.of_partner));
    }
    dst.slack = float(reach / 2);
    const V3d a = whole[1] - whole[0], b = whole[2] - whole[0];
    const double longest = std::max({ a.length(), b.length(), (a - b).length() });
    dst.tolerance = float(kOutwards / 4 * (1 + reach) * longest / a.cross(b).length());
}

// A triangle alone: the smallest of its own shape.
struct Shrunk
{
    std::array<double, 3> least { 0, 0, 0 }; // weights of the corners
    double size = 1; // of its edges

    double area() const { return size * size; }
};

Shrunk shrunk(const Corners& whole, const WeightRange& stopping)
{
    const double area2 = (whole[1] - whole[0]).cross(whole[2] - whole[0]).length();
    Shrunk result;
    for (size_t k = 0; k < 3; ++k) {
        const double height = area2 / (whole[(k + 2) % 3] - whole[(k + 1) % 3]).length();
        result.least[k] = double(stopping.least[k]) - kOutwards * (1 + reach_of(whole)) / height;
        result.size -= result.least[k];
    }
    const bool pays = result.size > 0 && result.area() <= kLargest; // not a number: it has no area
    return pays ? result : Shrunk();
}

Piece piece_of(const Corners& whole, const Shrunk& shrunk)
{
    Piece piece;
    for (size_t k = 0; k < 3; ++k) {
        piece.corners[k] = whole[k] * shrunk.size;
        for (size_t other = 0; other < 3; ++other)
            piece.corners[k] += whole[other] * shrunk.least[other];
        piece.own[k] = V2d(shrunk.least[1] + (k == 1) * shrunk.size, shrunk.least[2] + (k == 2) * shrunk.size);
    }
    return piece;
}

// Two triangles of a card, as a parallelogram: x and y are the weights of the corners that they share in the first one;
// beyond x + y = 1 is the second.
struct Card
{
    // Corners by number: those that are not shared, and those that are, x before y.
    size_t apex, x, y, other_apex, other_x, other_y;
    Corners corners, other_corners;
    V2d other_at; // where the other apex is: near (1, 1)

    V3d at(const V2d& p) const
    {
        const V3d& from = corners[apex];
        return from + (corners[x] - from) * p.x + (corners[y] - from) * p.y;
    }
    // Weights of the second and third corners.
    V2d weights(const V2d& p) const
    {
        std::array<double, 3> all;
        all[apex] = 1 - p.x - p.y, all[x] = p.x, all[y] = p.y;
        return { all[1], all[2] };
    }
    V2d other_weights(const V2d& p) const
    {
        std::array<double, 3> all;
        all[other_apex] = (p.x + p.y - 1) / (other_at.x + other_at.y - 1);
        all[other_x] = p.x - all[other_apex] * other_at.x;
        all[other_y] = p.y - all[other_apex] * other_at.y;
        return { all[1], all[2] };
    }
};

// The corners that two triangles of one winding share. False if they are not two.
bool find_shared(Card& dst, const std::array<uint32_t, 3>& a, const std::array<uint32_t, 3>& b)
{
    for (dst.apex = 0; dst.apex < 3; ++dst.apex) {
        dst.x = (dst.apex + 1) % 3, dst.y = (dst.apex + 2) % 3;
        for (dst.other_apex = 0; dst.other_apex < 3; ++dst.other_apex) {
            dst.other_y = (dst.other_apex + 1) % 3, dst.other_x = (dst.other_apex + 2) % 3;
            if (a[dst.x] == b[dst.other_x] && a[dst.y] == b[dst.other_y])
                return a[dst.apex] != b[dst.other_apex];
        }
    }
    return false;
}

// Is the card nearly a parallelogram? Sets `other_at`.
bool is_parallelogram(Card& card, double reach)
{
    const V3d &from = card.corners[card.apex], x = card.corners[card.x] - from, y = card.corners[card.y] - from;
    const V3d normal = x.cross(y), to = card.other_corners[card.other_apex] - from;
    const double area2 = normal.length2();
    card.other_at = V2d(to.cross(y).dot(normal) / area2, x.cross(to).dot(normal) / area2);
    return std::abs(to.dot(normal)) <= kFlat * (1 + reach) * std::sqrt(area2)
        && std::abs(card.other_at.x - 1) <= kSkewed && std::abs(card.other_at.y - 1) <= kSkewed;
}

// Where light is stopped, in x and y, and a little farther.
std::array<Span, 2> spans_of(const Card& card, const WeightRange& a, const WeightRange& b)
{
    const double reach = std::max(reach_of(card.corners), reach_of(card.other_corners));
    const V3d x = card.corners[card.x] - card.corners[card.apex], y = card.corners[card.y] - card.corners[card.apex];
    const double area2 = x.cross(y).length();
    const auto span = [&](size_t corner, size_t other_corner, double skew, double edge) {
        Span all { double(a.least[corner]), double(a.most[corner]) };
        all.add({ 1 - double(b.most[other_corner]) - skew, 1 - double(b.least[other_corner]) + skew });
        const double outwards = kOutwards * (1 + reach) * edge / area2;
        return Span { all.low - outwards, all.high + outwards };
    };
    return { span(card.x, card.other_y, std::abs(card.other_at.x - 1), y.length()),
             span(card.y, card.other_x, std::abs(card.other_at.y - 1), x.length()) };
}

// Half of a parallelogram, from one of its corners to the two beside it.
Piece half_of(const Card& card, const V2d& from, const V2d& to, bool is_other)
{
    const std::array<V2d, 3> at { from, V2d(to.x, from.y), V2d(from.x, to.y) };
    Piece piece;
    for (size_t k = 0; k < 3; ++k) {
        piece.corners[k] = card.at(at[k]);
        piece.own[k] = is_other ? card.other_weights(at[k]) : card.weights(at[k]);
        piece.of_partner[k] = is_other ? card.weights(at[k]) : card.other_weights(at[k]);
    }
    return piece;
}

// Of the points of a triangle, 0 or above.
float depth_inside(const V2f& weights)
{
    return std::min({ weights.x, weights.y, 1 - weights.x - weights.y });
}

void set_longest_edges(std::vector<TrimmedPiece>& pieces, const std::array<V3f, 3>* corners)
{
    for (size_t i = 0; i < pieces.size(); ++i)
        for (size_t k = 0; k < 3; ++k)
            pieces[i].longest_edge
                = std::max(pieces[i].longest_edge, (corners[i][k] - corners[i][(k + 1) % 3]).length());
}

} // namespace

std::pair<uint32_t, V2f> TrimmedPiece::whole(uint32_t triangle, float piece_u, float piece_v) const
{
    V2f at = own.at(piece_u, piece_v);
    if (!is_trimmed)
        return { triangle, at };
    if (partner != kAlone && depth_inside(at) < 0) {
        const V2f beside = of_partner.at(piece_u, piece_v);
        if (depth_inside(beside) > depth_inside(at)) {
            triangle = partner;
            at = beside;
        }
    }
    at.x = std::clamp(at.x, 0.0f, 1.0f);
    at.y = std::clamp(at.y, 0.0f, 1 - at.x);
    return { triangle, at };
}

std::vector<TrimmedPiece> whole_pieces(const std::array<V3f, 3>* corners, size_t count)
{
    std::vector<TrimmedPiece> pieces(count);
    set_longest_edges(pieces, corners);
    return pieces;
}

std::vector<TrimmedPiece> trim_triangles(std::array<V3f, 3>* corners,
                                         const std::vector<std::array<uint32_t, 3>>& triangles,
                                         const std::vector<uint8_t>& uses,
                                         const std::function<WeightRange(size_t triangle)>& stopping)
{
    std::vector<TrimmedPiece> pieces(triangles.size());
    const auto trim_pair = [&](size_t i, double area_alone) {
        Card card;
        if (!find_shared(card, triangles[i], triangles[i + 1]))
            return false;
        card.corners = in_double(corners[i]);
        card.other_corners = in_double(corners[i + 1]);
        const double reach = std::max(reach_of(card.corners), reach_of(card.other_corners));
        if (!is_parallelogram(card, reach))
            return false;
        const auto [x, y] = spans_of(card, stopping(i), stopping(i + 1));
        const bool is_apart = uses[triangles[i][card.apex]] == 1 && uses[triangles[i + 1][card.other_apex]] == 1
            && uses[triangles[i][card.x]] == 2 && uses[triangles[i][card.y]] == 2;
        if (std::min(x.low, y.low) <= 0 || std::max(x.high, y.high) >= 1)
            if (!is_apart)
                return false;
        // Not a number: it has no area. Boxes around a parallelogram are smaller than around two triangles.
        constexpr double kAsGood = 1.05;
        if (!(x.size() * y.size() <= std::min(kLargest, kAsGood * area_alone)))
            return false;
        const V2d low(x.low, y.low), high(x.high, y.high);
        set_piece(pieces[i], corners[i], half_of(card, low, high, false), reach, uint32_t(i + 1));
        set_piece(pieces[i + 1], corners[i + 1], half_of(card, high, low, true), reach, uint32_t(i));
        return true;
    };
    const auto shrunk_alone = [&](size_t i) {
        const WeightRange range = stopping(i);
        const bool touches
            = std::any_of(range.least.begin(), range.least.end(), [](float least) { return least <= 0; });
        const bool is_apart
            = std::all_of(triangles[i].begin(), triangles[i].end(), [&](uint32_t vertex) { return uses[vertex] == 1; });
        return touches && !is_apart ? Shrunk() : shrunk(in_double(corners[i]), range);
    };
    for (size_t i = 0; i < triangles.size(); ++i) {
        const Corners whole = in_double(corners[i]);
        const Shrunk alone = shrunk_alone(i);
        if (i + 1 < triangles.size()) {
            const Shrunk next = shrunk_alone(i + 1);
            if (trim_pair(i, (alone.area() + next.area()) / 2)) {
                ++i;
                continue;
            }
        }
        if (alone.size < 1)
            set_piece(pieces[i], corners[i], piece_of(whole, alone), reach_of(whole), TrimmedPiece::kAlone);
    }
    set_longest_edges(pieces, corners);
    return pieces;
}

} // namespace vmlight
