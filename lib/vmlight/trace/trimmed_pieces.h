// SPDX-License-Identifier: Apache-2.0
/// Cut-out triangles without the parts along their edges where light passes everywhere: rays that would go on from
/// there never meet them. Cards of leaves are mostly wider than the leaf.
#pragma once

#include <vmlight/trace/opacity_micromap.h>

#include <Imath/ImathVec.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace vmlight {

/// What is traced in place of a triangle: itself, a smaller one of the same shape, or half of the smallest
/// parallelogram around what stops light in it and its partner, the other triangle of a card.
struct TrimmedPiece
{
    static constexpr uint32_t kAlone = ~0u;

    /// The weights of a triangle's second and third corners, from those of a piece.
    struct Weights
    {
        std::array<float, 3> u { 0, 1, 0 }, v { 0, 0, 1 }; ///< a + b * u + c * v

        Imath::V2f at(float piece_u, float piece_v) const
        {
            return { u[0] + u[1] * piece_u + u[2] * piece_v, v[0] + v[1] * piece_u + v[2] * piece_v };
        }
    };

    bool is_trimmed = false;
    uint32_t partner = kAlone; ///< number of the triangle that some of its points may lie in
    Weights own, of_partner; ///< of the triangle, and of its partner
    float longest_edge = 0; ///< of the piece
    float error_scale = 1; ///< by how much errors of a piece's weights grow in those of triangles
    /// The piece's corners are rounded: by as much as the weights of a hit are off at this distance more.
    float slack = 0;
    /// Weights this far beyond an edge are still in the triangle, so that no ray slips through between it and an opaque
    /// neighbour, whose edge Embree tests in floats.
    float tolerance = 0;

    /// The triangle that a point of the piece is in, or nearest to, and the weights there.
    /// @param triangle     the piece's own
    std::pair<uint32_t, Imath::V2f> whole(uint32_t triangle, float piece_u, float piece_v) const;
};

/// Trim triangles where that pays. Edges with nothing to trim move outwards a little, so that no ray slips through
/// between the pieces of a card; a hit counts where it is in a triangle. Triangles that stop light up to an edge stay
/// whole if others have their vertices: Embree lets no ray through between edges of equal floats alone.
///
/// @param corners      of each triangle; set to those of its piece
/// @param triangles    their vertices. Two that follow each other and share an edge can be partners
/// @param uses         by how many triangles each vertex is used
/// @param stopping     of each triangle: the weights of the points that stop light
std::vector<TrimmedPiece> trim_triangles(std::array<Imath::V3f, 3>* corners,
                                         const std::vector<std::array<uint32_t, 3>>& triangles,
                                         const std::vector<uint8_t>& uses,
                                         const std::function<WeightRange(size_t triangle)>& stopping);

/// Of triangles that are traced as they are.
std::vector<TrimmedPiece> whole_pieces(const std::array<Imath::V3f, 3>* corners, size_t count);

} // namespace vmlight
