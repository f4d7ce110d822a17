// SPDX-License-Identifier: Apache-2.0
#include "compare.h"

#include <vmlight/base/oiio_compat.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vmlight::cost {
namespace {

constexpr int kError = 3, kCoverage = 6; // channels of a reference

template <class Each> void for_each_covered(const OIIO::ImageBuf& reference, Each&& each)
{
    for (OIIO::ImageBuf::ConstIterator<float> truth(reference); !truth.done(); ++truth)
        if (truth[kCoverage] > 0)
            each(truth);
}

} // namespace

OIIO::ImageBuf resize_to_reference(const OIIO::ImageBuf& lightmap, const OIIO::ImageBuf& reference)
{
    OIIO::ROI roi = reference.roi();
    roi.chend = 3;
    if (lightmap.spec().width == roi.width())
        return lightmap;
    OIIO::ImageBuf resized;
    oiio::resize(resized, lightmap, roi, 1);
    return resized;
}

Errors compare(const OIIO::ImageBuf& lightmap, const OIIO::ImageBuf& reference, const OIIO::ImageBuf& visibility)
{
    std::array<Batch, kBatches> batches, by_visibility;
    std::vector<float> distances;
    double sum = 0;
    OIIO::ImageBuf::ConstIterator<float> model(lightmap), weight(visibility);
    for_each_covered(reference, [&](const auto& truth) {
        model.pos(truth.x(), truth.y());
        weight.pos(truth.x(), truth.y());
        const size_t batch = size_t(batch_of(truth.x(), truth.y()));
        for (int c = 0; c < 3; ++c) {
            batches[batch].add(model[c], truth[c], truth[kError + c]);
            by_visibility[batch].add(model[c], truth[c], truth[kError + c], weight[0]);
            distances.push_back(std::abs(model[c] - truth[c]));
            sum += truth[c];
        }
    });
    Errors errors = errors_of(batches);
    // Light may come through a gap that no ray of the visibility map found.
    const auto is_lit = [](const Batch& batch) { return batch.reference > 0; };
    errors.rmse_by_visibility = std::count_if(by_visibility.begin(), by_visibility.end(), is_lit) < 2
        ? errors.rmse.value
        : errors_of(by_visibility).rmse.value;
    errors.p95 = quantile(distances, 0.95) * double(distances.size()) / sum;
    return errors;
}

int64_t covered_texels(const OIIO::ImageBuf& reference)
{
    int64_t count = 0;
    for_each_covered(reference, [&](const auto&) { ++count; });
    return count;
}

int lit_batches(const OIIO::ImageBuf& reference)
{
    std::array<bool, kBatches> lit {};
    for_each_covered(reference, [&](const auto& truth) {
        if (truth[0] + truth[1] + truth[2] > 0)
            lit[size_t(batch_of(truth.x(), truth.y()))] = true;
    });
    return int(std::count(lit.begin(), lit.end(), true));
}

} // namespace vmlight::cost
