// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/turned_texels.h>

#include <vmlight/image/channels.h>
#include <vmlight/math/harmonics.h>
#include <vmlight/trace/rigid_motion.h>
#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/basis.h>

#include <algorithm>

namespace vmlight {

using Imath::V3d;

TexelTurn::Kind TexelTurn::kind(const VismapParams& params)
{
    if (!params.sun_directions.empty())
        return Kind::none;
    return basis_channels(params).empty() ? Kind::any : params.basis == "sh" ? Kind::prepared : Kind::none;
}

TexelTurn::TexelTurn(const VismapParams& params, const Rotation& turn)
    : m_turn(turn)
    , m_is_straight(is_straight(turn))
    , m_has_normal(params.has("normal"))
    , m_channels(size_t(describe_vismap("", params).nchannels))
    , m_bands_at(kVismapChannels.size() + (params.has("normal") ? 3 : 0) + (params.has("error") ? 1 : 0))
{
    if (kind(params) != Kind::prepared || m_is_straight)
        return;
    // What was seen along w is now seen along R w: the bands of f(R^-1 w).
    const Rotation back = turn.transposed();
    m_order = params.order;
    const auto count = size_t(m_order * m_order);
    m_matrix.assign(count * count, 0);
    for (size_t first = 0; first < count; first += 3) { // a column in each of R, G and B
        std::vector<double> unit(3 * count, 0.0);
        for (size_t c = 0; c < 3 && first + c < count; ++c)
            unit[3 * (first + c) + c] = 1;
        const std::vector<double> turned = rotate_harmonics(unit, m_order, back);
        for (size_t c = 0; c < 3 && first + c < count; ++c)
            for (size_t k = 0; k < count; ++k)
                m_matrix[k * count + first + c] = turned[3 * k + c];
    }
}

void TexelTurn::copy(const float* from, float* to) const
{
    std::copy(from, from + m_channels, to);
    if (m_is_straight)
        return;
    const auto turn_vector = [&](size_t at) {
        const V3d v = rotate(m_turn, V3d(from[at], from[at + 1], from[at + 2]));
        for (int c = 0; c < 3; ++c)
            to[at + size_t(c)] = float(v[c]);
    };
    turn_vector(1);
    if (m_has_normal)
        turn_vector(kVismapChannels.size());
    const auto count = size_t(m_order * m_order);
    for (int l = 2; l < m_order; ++l)
        for (int k = l * l; k < (l + 1) * (l + 1); ++k) {
            double sum = 0;
            for (int j = l * l; j < (l + 1) * (l + 1); ++j)
                sum += m_matrix[size_t(k) * count + size_t(j)] * double(from[m_bands_at + size_t(j) - 4]);
            to[m_bands_at + size_t(k) - 4] = float(sum);
        }
}

} // namespace vmlight
