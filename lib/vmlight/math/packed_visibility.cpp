// SPDX-License-Identifier: Apache-2.0
#include <vmlight/math/packed_visibility.h>

#include <vmlight/math/latlong.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vmlight {

using namespace direction_grid;
using Imath::V3d;

namespace {

// The fine slices of a column whose centre is above the horizon of `normal`.
struct Span
{
    int first, last;
};

Span above_horizon(int column, const V3d& normal, int fine)
{
    const double around = column_middle(column).dot(normal), up = normal.y;
    const double length = std::hypot(around, up);
    if (up == 0)
        return around > 0 ? Span { 0, fine - 1 } : Span { fine, -1 };
    const double horizon = (up > 0 ? -around : around) / length;
    const int slice = std::clamp(int((horizon + 1) * 0.5 * fine), 0, fine - 1);
    return up > 0 ? Span { slice, fine - 1 } : Span { 0, slice };
}

} // namespace

void pack_mask(float* packed, const MaskColumn* columns)
{
    std::array<uint32_t, 18> code {};
    for (int c = 0; c < kColumns; ++c)
        code[size_t(c)]
            = uint32_t(columns[c].low) << 10 | uint32_t(columns[c].high) << 4 | uint32_t(columns[c].density);
    for (int i = 0; i < kMaskFloats; ++i) {
        const uint32_t* three = &code[size_t(i / 2 * 3)];
        packed[i] = float(i % 2 == 0 ? three[0] << 8 | three[1] >> 8 : (three[1] & 255) << 16 | three[2]);
    }
}

void pack_cells(float* packed, const uint8_t* thirds)
{
    for (int i = 0; i < kCellsFloats; ++i) {
        uint32_t code = 0;
        for (int c = 0; c < kCellsPerFloat; ++c)
            code = code << 2 | thirds[i * kCellsPerFloat + c];
        packed[i] = float(code);
    }
}

VisibilityGrid::VisibilityGrid()
    : m_counts(size_t(kColumns) * kFine)
{
}

void VisibilityGrid::set_rays(const RayFan& fan, const std::vector<uint8_t>& traced)
{
    for (int column = 0; column < kColumns; ++column)
        if (m_used >> column & 1)
            std::fill_n(m_counts.begin() + column * kFine, kFine, Count {});
    m_used = 0;
    m_traced = m_visible = 0;
    for (int packet = 0; packet < fan.packets; ++packet)
        for (int lane = 0; lane < kPacketSize; ++lane) {
            if (!(traced[size_t(packet)] >> lane & 1))
                continue;
            const int ray = packet * kPacketSize + lane;
            const int column = column_of(fan.x[ray], fan.z[ray]);
            Count& count = m_counts[size_t(column * kFine + slice_of(fan.y[ray], kFine))];
            ++count.traced;
            const uint32_t visible = fan.lanes[size_t(packet)] >> lane & 1;
            count.visible += visible;
            m_visible += visible;
            m_used |= 1u << column;
            ++m_traced;
        }
}

// An edge is half-way between the last visible ray and the next occluded one, or at the horizon if there is none.
MaskColumn VisibilityGrid::column_with_rays(int column, const V3d& normal) const
{
    const Count* counts = &m_counts[size_t(column * kFine)];
    int first = kFine, last = -1, first_any = kFine, last_any = -1;
    uint32_t visible = 0;
    for (int i = 0; i < kFine; ++i) {
        if (!counts[i].visible)
            continue;
        visible += counts[i].visible;
        first_any = std::min(first_any, i);
        last_any = i;
        if (2 * counts[i].visible > counts[i].traced) {
            first = std::min(first, i);
            last = i;
        }
    }
    if (!visible)
        return {};
    if (last < 0)
        first = first_any, last = last_any;
    const Span above = above_horizon(column, normal, kFine);
    int below = first - 1, beyond = last + 1;
    while (below >= 0 && !counts[below].traced)
        --below;
    while (beyond < kFine && !counts[beyond].traced)
        ++beyond;
    const int low = std::max(below < 0 ? 0 : (first + below + 1) / 2, std::min(above.first, first));
    const int high = std::min(beyond >= kFine ? kFine - 1 : (last + beyond) / 2, std::max(above.last, last));

    MaskColumn mask;
    mask.low = (low + 2) / 4;
    mask.high = (high + 1 + 2) / 4;
    if (mask.high <= mask.low) {
        mask.low = std::min(kSlices - 1, (low + high + 1) / 8);
        mask.high = mask.low + 1;
    }
    const auto& moments = running_moments()[size_t(column)];
    const double whole = normal.dot(moments[size_t(mask.high)] - moments[size_t(mask.low)]) / latlong::pi;
    const double part = double(visible) / double(m_traced);
    mask.density = part < whole ? std::max(1, int(15 * part / whole + 0.5)) : 15;
    return mask;
}

MaskColumn VisibilityGrid::column_without_rays(int column, const V3d& normal, const V3d& surface) const
{
    const Span of_normal = above_horizon(column, normal, kFine), of_surface = above_horizon(column, surface, kFine);
    const Span above { std::max(of_normal.first, of_surface.first), std::min(of_normal.last, of_surface.last) };
    const int low = (above.first + 2) / 4, high = (above.last + 3) / 4;
    const int density = m_traced ? int(15 * double(m_visible) / double(m_traced) + 0.5) : 0;
    return high > low && density > 0 ? MaskColumn { low, high, density } : MaskColumn {};
}

void VisibilityGrid::mask(float* packed, const V3d& normal, const V3d& surface) const
{
    std::array<MaskColumn, kColumns> columns;
    for (int column = 0; column < kColumns; ++column)
        columns[size_t(column)]
            = m_used >> column & 1 ? column_with_rays(column, normal) : column_without_rays(column, normal, surface);
    pack_mask(packed, columns.data());
}

void VisibilityGrid::cells(float* packed, const V3d& normal, const V3d& surface) const
{
    constexpr int kFinePerBand = kFine / kBands;
    const double whole = m_traced ? double(m_visible) / double(m_traced) : 0;
    std::array<double, kCells> above {}, below {}; // cells with Int n.w dw > 0, and the others
    for (int column = 0; column < kColumns; ++column) {
        std::array<Count, kBands> bands {};
        for (int i = 0; i < kFine && m_used >> column & 1; ++i) {
            Count& sum = bands[size_t(i / kFinePerBand)];
            sum.traced += m_counts[size_t(column * kFine + i)].traced;
            sum.visible += m_counts[size_t(column * kFine + i)].visible;
        }
        // A cell without rays takes the nearest in its column that has some.
        const auto share_near = [&](int band) {
            for (int far = 0; far < kBands; ++far)
                for (const int other : { band + far, band - far })
                    if (other >= 0 && other < kBands && bands[size_t(other)].traced)
                        return double(bands[size_t(other)].visible) / bands[size_t(other)].traced;
            return whole;
        };
        const auto& moments = running_moments()[size_t(column)];
        for (int band = 0; band < kBands; ++band) {
            const size_t edge = size_t(band * kSlicesPerBand);
            const V3d moment = moments[edge + kSlicesPerBand] - moments[edge];
            const bool counts = normal.dot(moment) > 0;
            if (bands[size_t(band)].traced || (counts && surface.dot(moment) > 0))
                (counts ? above : below)[size_t(band * kColumns + column)] = share_near(band);
        }
    }
    // Cells mostly below the horizon would subtract light: use them only if no other cell is visible.
    const bool any = *std::max_element(above.begin(), above.end()) > 0;
    const std::array<double, kCells>& share = any ? above : below;
    const double best = *std::max_element(share.begin(), share.end());
    std::array<uint8_t, kCells> thirds {};
    for (int cell = 0; cell < kCells && best > 0; ++cell)
        thirds[size_t(cell)] = uint8_t(3 * share[size_t(cell)] / best + 0.5);
    pack_cells(packed, thirds.data());
}

} // namespace vmlight
