// SPDX-License-Identifier: Apache-2.0
/// What a map has of a texel, turned with the surface.
#pragma once

#include <vmlight/math/rotation.h>
#include <vmlight/vismap/vismap.h>

#include <cstddef>
#include <vector>

namespace vmlight {

/// Turns the channels of a map. For many texels of one rotation, such as those of a rigid body.
class TexelTurn
{
public:
    /// Whether maps of these parameters can be turned by any rotation, by those that prepared() knows, or by none at
    /// all (`mask`, `cells`, suns).
    enum class Kind
    {
        any,
        prepared,
        none
    };
    static Kind kind(const VismapParams& params);

    TexelTurn(const VismapParams& params, const Rotation& turn);

    /// Copy a texel of describe_vismap()'s channels, turned.
    void copy(const float* from, float* to) const;

private:
    Rotation m_turn;
    bool m_is_straight, m_has_normal;
    size_t m_channels, m_bands_at;
    int m_order = 0; // of the bands; 0: none
    std::vector<double> m_matrix; // of the bands, rows and columns as in sh.<number>
};

} // namespace vmlight
