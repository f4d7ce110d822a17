// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cfem/prefix.h>

#include <algorithm>
#include <array>
#include <cstdint>

namespace vmlight {

namespace {

constexpr int kSegments = 64; // of the circle; two neighbours are a place

} // namespace

RowLight make_prefix(PrefixCell* cells, const float* pixels, const std::vector<ColumnAngle>& edges)
{
    const int width = int(edges.size()) - 1, segments = std::min(kSegments, width);
    std::array<std::array<double, 3>, kSegments> segment_end;
    int segment = 0;
    RowLight light;
    Moments& sum = light.total;
    PrefixCell* cell = cells + 1;
    for (int i = 0; i < width; ++i, pixels += 3, ++cell) {
        const ColumnAngle &left = edges[i], &right = edges[i + 1];
        for (int k = 0; k < 3; ++k) {
            const double value = pixels[k];
            cell->zero[k] = sum.zero[k] - value * left.phi;
            cell->slope[k] = value;
            cell->cosine[k] = sum.cosine[k] - value * left.sine;
            cell->sine[k] = sum.sine[k] + value * left.cosine;
            sum.zero[k] += value * (right.phi - left.phi);
            sum.cosine[k] += value * (right.sine - left.sine);
            sum.sine[k] -= value * (right.cosine - left.cosine);
        }
        if (i + 1 == int64_t(width) * (segment + 1) / segments)
            segment_end[segment++] = { sum.zero[0], sum.zero[1], sum.zero[2] };
    }
    cells[0] = cells[1];
    cells[width + 1] = cells[width];

    for (int k = 0; k < 3; ++k) {
        light.brightest[k] = segments > 2 ? 0 : sum.zero[k];
        // From the end of segment i to that of segment i + 2, over the seam too.
        for (int i = 0; i < segments && segments > 2; ++i) {
            const int end = (i + 2) % segments;
            const double turn = end <= i ? sum.zero[k] : 0;
            light.brightest[k] = std::max(light.brightest[k], turn + segment_end[end][k] - segment_end[i][k]);
        }
    }
    return light;
}

} // namespace vmlight
