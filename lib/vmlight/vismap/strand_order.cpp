// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/strand_order.h>

#include <vmlight/trace/occluder.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace vmlight {
namespace {

using Imath::V3d;

constexpr int kBits = 10; // along each axis

// Bits of three coordinates in [-1, 1], interleaved.
uint32_t place_code(const V3d& p)
{
    uint32_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const auto cell = uint32_t(std::clamp((p[axis] + 1) * (1 << (kBits - 1)), 0.0, double((1 << kBits) - 1)));
        for (int bit = 0; bit < kBits; ++bit)
            code |= (cell >> bit & 1) << (3 * bit + axis);
    }
    return code;
}

} // namespace

std::vector<uint32_t> strands_by_place(const Strands& strands)
{
    V3d low(std::numeric_limits<double>::infinity()), high(-std::numeric_limits<double>::infinity());
    for (size_t strand = 0; strand < strands.count(); ++strand)
        for (int axis = 0; axis < 3; ++axis) {
            const double x = strands.points[strands.begin(strand)][axis];
            low[axis] = std::min(low[axis], x);
            high[axis] = std::max(high[axis], x);
        }
    const SceneFrame frame = SceneFrame::around(low, high);
    std::vector<uint32_t> codes, order(strands.count());
    for (size_t strand = 0; strand < strands.count(); ++strand)
        codes.push_back(place_code((strands.points[strands.begin(strand)] - frame.centre) * frame.scale));
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return codes[a] < codes[b]; });
    return order;
}

} // namespace vmlight
