// SPDX-License-Identifier: Apache-2.0
// Compiled once for each instruction set that the compiler and the machine may have: Highway includes this file again.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vmlight/cfem/kernel.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include <vmlight/cfem/kernel.h>

HWY_BEFORE_NAMESPACE();
namespace vmlight {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void add_arcs(ColumnSum* HWY_RESTRICT sums, const PrefixCell* HWY_RESTRICT cells,
              const ColumnAngle* HWY_RESTRICT columns, const ArcRun& run)
{
    const hn::CappedTag<double, 4> d;
    const auto upward = hn::Set(d, run.upward), sideward = hn::Set(d, run.sideward);
    const auto slope_at_end = hn::Set(d, run.slope_at_end[0]), slope_at_start = hn::Set(d, run.slope_at_end[1]);
    const int64_t step = run.step;
    int64_t position0 = run.end[0] + run.first * step, position1 = run.end[1] + run.first * step;
    for (int c = run.first; c < run.last; ++c, position0 += step, position1 += step) {
        const PrefixCell& e = cells[position0 >> 32];
        const PrefixCell& s = cells[position1 >> 32];
        const auto turn = hn::Set(d, columns[c].phi);
        const auto e_slope = hn::MulAdd(upward, turn, slope_at_end);
        const auto s_slope = hn::MulAdd(upward, turn, slope_at_start);
        const auto cosine = hn::Mul(sideward, hn::Set(d, columns[c].cosine));
        const auto sine = hn::Mul(sideward, hn::Set(d, columns[c].sine));
        double* half0 = sums[c].half[0];
        double* half1 = sums[c].half[1];
        for (size_t i = 0; i < 4; i += hn::Lanes(d)) {
            const auto zero = hn::Sub(hn::Load(d, e.zero + i), hn::Load(d, s.zero + i));
            const auto cosines = hn::Sub(hn::Load(d, e.cosine + i), hn::Load(d, s.cosine + i));
            const auto sines = hn::Sub(hn::Load(d, e.sine + i), hn::Load(d, s.sine + i));
            auto sum0 = hn::Load(d, half0 + i), sum1 = hn::Load(d, half1 + i);
            sum0 = hn::MulAdd(upward, zero, sum0);
            sum1 = hn::MulAdd(e_slope, hn::Load(d, e.slope + i), sum1);
            sum0 = hn::MulAdd(cosine, cosines, sum0);
            sum1 = hn::NegMulAdd(s_slope, hn::Load(d, s.slope + i), sum1);
            sum1 = hn::MulAdd(sine, sines, sum1);
            hn::Store(sum0, d, half0 + i);
            hn::Store(sum1, d, half1 + i);
        }
    }
}

} // namespace HWY_NAMESPACE
} // namespace vmlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vmlight {

HWY_EXPORT(add_arcs);

void add_arcs(ColumnSum* sums, const PrefixCell* cells, const ColumnAngle* columns, const ArcRun& run)
{
    HWY_DYNAMIC_DISPATCH(add_arcs)(sums, cells, columns, run);
}

void add_arcs_scalar(ColumnSum* sums, const PrefixCell* cells, const ColumnAngle* columns, const ArcRun& run)
{
    for (int c = run.first; c < run.last; ++c) {
        const PrefixCell& e = cells[(run.end[0] + c * run.step) >> 32];
        const PrefixCell& s = cells[(run.end[1] + c * run.step) >> 32];
        const double e_slope = run.upward * columns[c].phi + run.slope_at_end[0];
        const double s_slope = run.upward * columns[c].phi + run.slope_at_end[1];
        const double cosine = run.sideward * columns[c].cosine, sine = run.sideward * columns[c].sine;
        for (int i = 0; i < 4; ++i) {
            sums[c].half[0][i] += run.upward * (e.zero[i] - s.zero[i]);
            sums[c].half[1][i] += e_slope * e.slope[i];
            sums[c].half[0][i] += cosine * (e.cosine[i] - s.cosine[i]);
            sums[c].half[1][i] -= s_slope * s.slope[i];
            sums[c].half[1][i] += sine * (e.sine[i] - s.sine[i]);
        }
    }
}

} // namespace vmlight
#endif
