// SPDX-License-Identifier: Apache-2.0
/// The texels that the reconstruction of a tile reads, one plane for each quantity.
#pragma once

#include <vmlight/base/tile_size.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vmlight {

/// The variance of V and B' together, in that of V: 1 + 5/9 where rays are independent. B' is B less that of an open
/// texel of the same V.
constexpr float kVarianceOfBoth = 14.0f / 9;

/// How much farther apart on the surface than UVs say two texels may be, squared.
constexpr float kStretch = 2.25f;

/// A tile and the texels around it.
struct NeighbourWindow
{
    static constexpr int kReach = 3; ///< of neighbours, in texels
    static constexpr int kPatch = 1; ///< of the patches that are compared around both
    static constexpr int kHalo = kReach + kPatch;
    static constexpr int kSide = kTileSize + 2 * kHalo;
    /// A row, with room for vectors that reach past its end.
    static constexpr int kStride = kSide + 8;
    static constexpr int kNeighbours = (2 * kReach + 1) * (2 * kReach + 1) - 1;
    static constexpr size_t kTexels = size_t(kTileSize) * kTileSize;

    using Plane = std::vector<float>;
    NeighbourWindow();

    /// Of the texel at (x, y) from the tile's first one, both at least -kHalo.
    static size_t index(int x, int y) { return size_t(y + kHalo) * kStride + size_t(x + kHalo); }
    /// Forget all texels. All of the tile are wanted.
    void clear();

    /// The texels of the tile to reconstruct; bit x of word y. What the functions below set for others means nothing.
    std::array<uint64_t, kTileSize> wanted;

    /// V, and the three of B less that of an open texel of this V, (2/3) V n.
    std::array<Plane, 4> values;
    /// The variance of V.
    Plane variance;
    /// The unit normal, the position, and the distance to the next texel. The last is 0 where there is no texel.
    std::array<Plane, 3> normal, position;
    Plane spacing;

    /// 1 where a texel gives to others, 0 where it does not: all do, unless it is set after clear().
    Plane gives;

    /// Where neighbour `number` is from a texel: row by row, without the texel itself.
    struct Offset
    {
        int x, y;
    };
    static constexpr Offset neighbour(int number)
    {
        constexpr int kAcross = 2 * kReach + 1;
        const int cell = number + (number >= kNeighbours / 2);
        return { cell % kAcross - kReach, cell / kAcross - kReach };
    }

    /// Where neighbour `number` of texel `texel` of the tile is in `weights` and `nearness`. Neighbours are not a power
    /// of two apart: the cache would have few places for all of a texel.
    static constexpr size_t weight(int number, size_t texel) { return size_t(number) * (kTexels + 16) + texel; }

    /// What fit_neighbours() sets, of the tile, row by row.
    struct Fit
    {
        /// At weight(), how near the neighbour is on the surface, from 0 to 1; 0 where it gives nothing.
        std::vector<float> nearness;
        /// By how much V and B' rise with each texel to the right, and down; 0 where no plane tells more than chance,
        /// or where much is left that it does not explain.
        std::array<std::array<std::vector<float>, 4>, 2> slopes;
        /// Whether any is not 0.
        bool is_sloped = false;
        /// How the slopes follow from the differences of neighbours: the slope to the right is the sum of the
        /// differences, each by its nearness, and by xx (x - middle x) + xy (y - middle y); down likewise.
        std::vector<float> xx, xy, yy, middle_x, middle_y;
        /// 1 where the neighbours scatter around the plane by little more than chance, 0 where they do by far more.
        std::vector<float> evenness;
    } fit;

    /// Set by weigh_neighbours(): for each neighbour its weight in each texel of the tile, row by row, some below 0;
    /// and that of the texel itself. Their sum is 1.
    std::vector<float> weights, own_weight;
};

/// Whether the tile wants a texel from `first` to `last` of a row.
inline bool wants_any(uint64_t row, int first, int last)
{
    first = first < 0 ? 0 : first;
    last = last < kTileSize ? last : kTileSize - 1;
    return first <= last && (row >> first & ~uint64_t(0) >> (kTileSize - 1 - last + first)) != 0;
}

} // namespace vmlight
