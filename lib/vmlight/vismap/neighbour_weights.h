// SPDX-License-Identifier: Apache-2.0
/// How much of a neighbouring texel goes into a texel: the vector kernels of reconstruction.
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

/// A tile and the texels around it that its reconstruction reads, one plane for each quantity.
struct NeighbourWindow
{
    static constexpr int kReach = 3; ///< of neighbours, in texels
    static constexpr int kPatch = 1; ///< of the patches that are compared around both
    static constexpr int kHalo = kReach + kPatch;
    static constexpr int kSide = kTileSize + 2 * kHalo;
    /// A row, with room for vectors that reach past its end.
    static constexpr int kStride = kSide + 8;
    static constexpr int kNeighbours = (2 * kReach + 1) * (2 * kReach + 1) - 1;

    using Plane = std::vector<float>;
    NeighbourWindow();

    /// Of the texel at (x, y) from the tile's first one, both at least -kHalo.
    static size_t index(int x, int y) { return size_t(y + kHalo) * kStride + size_t(x + kHalo); }
    /// Forget all texels. All of the tile are wanted.
    void clear();

    /// The texels of the tile to reconstruct; bit x of word y. What the functions below set for others means nothing.
    std::array<uint64_t, kTileSize> wanted;

    /// V, and B less that of an open texel of this V, (2/3) V n.
    Plane visibility, x, y, z;
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

    /// Set by weigh_neighbours(): for each neighbour its weight in each texel of the tile, row by row, and one over
    /// their sum, in which the texel itself has the weight 1.
    std::vector<float> weights, scale;
    Plane scratch_difference, scratch_expected, scratch_surface;
    std::vector<float> scratch_evenness;
};

/// Weigh the neighbours of each texel of the tile by how alike the patches around both are, beyond what their variance
/// explains, by normals and distance on the surface. A weight is exactly 0 where they differ by more than chance. How
/// much more two may differ depends on whether all around the texel do (neighbour_scatter.h).
/// Source: A. Buades, B. Coll, J.-M. Morel, "A non-local algorithm for image denoising", CVPR 2005; with the variance
/// of F. Rousselle, C. Knaus, M. Zwicker, "Adaptive rendering with non-local means filtering", TOG 31(6), 2012.
void weigh_neighbours(NeighbourWindow& window);

/// Set `change` (of the tile, row by row) to the weighted mean of what `plane` has in a texel and its neighbours, less
/// what it has in the texel itself. Exactly 0 where they have the same.
void mean_change(const NeighbourWindow& window, const float* plane, float* change);

/// Set `variance` (of the tile, row by row) to that of the weighted mean, if texels are independent.
void mean_variance(const NeighbourWindow& window, float* variance);

} // namespace vmlight
