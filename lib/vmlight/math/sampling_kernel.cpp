// SPDX-License-Identifier: Apache-2.0
#include <vmlight/math/sampling_kernel.h>

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vmlight/math/sampling_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vmlight::kernel {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Imath::V3f;

// At most eight lanes, one packet. The lane counts of all targets divide eight.
using FloatTag = hn::CappedTag<float, kPacketSize>;
using IntTag = hn::RebindToUnsigned<FloatTag>;
using FloatVec = hn::Vec<FloatTag>;
using IntVec = hn::Vec<IntTag>;

HWY_INLINE IntVec reverse_bits(IntVec x)
{
    const IntTag d;
    const auto swap = [&](uint32_t mask, auto left, auto right) {
        const auto m = hn::Set(d, mask);
        return hn::Or(left(hn::And(x, m)), hn::And(right(x), m));
    };
    x = hn::Or(hn::ShiftLeft<16>(x), hn::ShiftRight<16>(x));
    x = swap(
        0x00ff00ffu, [](auto v) { return hn::ShiftLeft<8>(v); }, [](auto v) { return hn::ShiftRight<8>(v); });
    x = swap(
        0x0f0f0f0fu, [](auto v) { return hn::ShiftLeft<4>(v); }, [](auto v) { return hn::ShiftRight<4>(v); });
    x = swap(
        0x33333333u, [](auto v) { return hn::ShiftLeft<2>(v); }, [](auto v) { return hn::ShiftRight<2>(v); });
    return swap(
        0x55555555u, [](auto v) { return hn::ShiftLeft<1>(v); }, [](auto v) { return hn::ShiftRight<1>(v); });
}

HWY_INLINE IntVec scramble(IntVec x, uint32_t seed)
{
    const IntTag d;
    x = hn::Add(x, hn::Set(d, seed));
    for (uint32_t factor : { 0x6c50b47cu, 0xb82f1e52u, 0xc7afe638u, 0x8d22f6e6u })
        x = hn::Xor(x, hn::Mul(x, hn::Set(d, factor)));
    return reverse_bits(x);
}

HWY_INLINE FloatVec unit_fraction(IntVec x)
{
    const FloatTag d;
    const hn::RebindToSigned<FloatTag> di;
    return hn::Mul(hn::ConvertTo(d, hn::BitCast(di, hn::ShiftRight<8>(x))), hn::Set(d, 0x1p-24f));
}

// sin(2 pi x) for |x| <= 1/4: interpolated at Chebyshev nodes, error below 1.7e-7.
HWY_INLINE FloatVec sin_turns(FloatVec x)
{
    const FloatTag d;
    const auto y = hn::Mul(x, x);
    auto sum = hn::Set(d, 39.75982666015625f);
    for (float c : { -76.58116912841797f, 81.60247802734375f, -41.34168243408203f, 6.2831854820251465f })
        sum = hn::Add(hn::Mul(sum, y), hn::Set(d, c));
    return hn::Mul(sum, x);
}

// cos and sin of an angle in turns, in [-1/2, 1/2), plus half a turn.
HWY_INLINE void circle(FloatVec turn, FloatVec& x, FloatVec& y)
{
    const FloatTag d;
    const auto quarter = hn::Set(d, 0.25f), half = hn::Set(d, 0.5f);
    const auto folded = hn::IfThenElse(hn::Gt(hn::Abs(turn), quarter), hn::Sub(hn::CopySign(half, turn), turn), turn);
    x = hn::Neg(sin_turns(hn::Sub(quarter, hn::Abs(turn))));
    y = hn::Neg(sin_turns(folded));
}

void strand_directions_target(const Points& points, const StrandAngles& angles, const TangentFrame& frame, RayFan& fan)
{
    const FloatTag d;
    const IntTag du;
    const hn::RebindToSigned<FloatTag> di;
    const int lanes = int(hn::Lanes(d));
    const auto one = hn::Set(d, 1.0f), quarter = hn::Set(d, 0.25f), half = hn::Set(d, 0.5f);
    const V3f &t = frame.tangent, &b = frame.bitangent, &n = frame.normal;
    constexpr int kShift = 23 - StrandAngles::kBits;
    constexpr int kFirst = (127 - 1 - StrandAngles::kOctaves) << StrandAngles::kBits; // that of 2^-25
    for (int i = 0; i < fan.packets * kPacketSize; i += lanes) {
        auto u = hn::LoadU(du, points.u + i), v = hn::LoadU(du, points.v + i);
        u = points.owen ? scramble(u, points.texel_u) : hn::Add(u, hn::Set(du, points.texel_u));
        v = points.owen ? scramble(v, points.texel_v) : hn::Add(v, hn::Set(du, points.texel_v));
        const auto from_root = hn::Add(unit_fraction(u), hn::Set(d, 0x1p-25f)); // the middle of what the bits say
        const auto share = hn::Min(from_root, hn::Max(hn::Sub(one, from_root), hn::Set(d, 0x1p-25f)));
        const auto bits = hn::BitCast(di, share);
        const auto entry = hn::Sub(hn::ShiftRight<kShift>(bits), hn::Set(di, kFirst));
        const auto rest = hn::Mul(hn::ConvertTo(d, hn::And(bits, hn::Set(di, (1 << kShift) - 1))),
                                  hn::Set(d, 1.0f / (1 << kShift)));
        const auto low = hn::GatherIndex(d, angles.turns.data(), entry),
                   high = hn::GatherIndex(d, angles.turns.data() + 1, entry);
        const auto angle = hn::Add(low, hn::Mul(hn::Sub(high, low), rest));
        const auto sine = sin_turns(angle);
        const auto along = hn::IfThenElse(hn::Gt(from_root, half), hn::Neg(sin_turns(hn::Sub(quarter, angle))),
                                          sin_turns(hn::Sub(quarter, angle)));
        auto x = one, y = one;
        circle(hn::Sub(unit_fraction(v), half), x, y);
        x = hn::Mul(x, sine);
        y = hn::Mul(y, sine);
        const auto local = [&](float tangent, float bitangent, float normal) {
            return hn::Add(hn::Add(hn::Mul(hn::Set(d, tangent), x), hn::Mul(hn::Set(d, bitangent), y)),
                           hn::Mul(hn::Set(d, normal), along));
        };
        hn::StoreU(local(t.x, b.x, n.x), d, fan.x + i);
        hn::StoreU(local(t.y, b.y, n.y), d, fan.y + i);
        hn::StoreU(local(t.z, b.z, n.z), d, fan.z + i);
    }
}

void directions_target(const Points& points, const TangentFrame& frame, const V3f& geometric_normal, RayFan& fan)
{
    const FloatTag d;
    const IntTag du;
    const int lanes = int(hn::Lanes(d));
    const auto one = hn::Set(d, 1.0f), half = hn::Set(d, 0.5f);
    const auto dot = [&](const V3f& v, FloatVec x, FloatVec y, FloatVec z) {
        return hn::Add(hn::Add(hn::Mul(hn::Set(d, v.x), x), hn::Mul(hn::Set(d, v.y), y)), hn::Mul(hn::Set(d, v.z), z));
    };
    const V3f &t = frame.tangent, &b = frame.bitangent, &n = frame.normal;
    std::fill(fan.lanes.begin(), fan.lanes.end(), uint8_t(0));
    for (int i = 0; i < fan.packets * kPacketSize; i += lanes) {
        auto u = hn::LoadU(du, points.u + i), v = hn::LoadU(du, points.v + i);
        u = points.owen ? scramble(u, points.texel_u) : hn::Add(u, hn::Set(du, points.texel_u));
        v = points.owen ? scramble(v, points.texel_v) : hn::Add(v, hn::Set(du, points.texel_v));
        const auto fu = unit_fraction(u);
        const auto turn = hn::Sub(unit_fraction(v), half); // azimuth minus half a turn, in [-1/2, 1/2)

        const auto radius = hn::Sqrt(points.uniform ? hn::Mul(fu, hn::Sub(hn::Set(d, 2.0f), fu)) : fu);
        const auto height = points.uniform ? hn::Sub(one, fu) : hn::Sqrt(hn::Sub(one, fu));
        auto local_x = one, local_y = one;
        circle(turn, local_x, local_y);
        local_x = hn::Mul(radius, local_x);
        local_y = hn::Mul(radius, local_y);

        const auto x = dot(V3f(t.x, b.x, n.x), local_x, local_y, height);
        const auto y = dot(V3f(t.y, b.y, n.y), local_x, local_y, height);
        const auto z = dot(V3f(t.z, b.z, n.z), local_x, local_y, height);
        hn::StoreU(x, d, fan.x + i);
        hn::StoreU(y, d, fan.y + i);
        hn::StoreU(z, d, fan.z + i);

        const auto exists = hn::Lt(hn::Iota(du, uint32_t(i)), hn::Set(du, uint32_t(points.count)));
        const auto above = hn::Gt(dot(geometric_normal, x, y, z), hn::Zero(d));
        uint8_t bits[8] = {};
        hn::StoreMaskBits(d, hn::And(above, hn::RebindMask(d, exists)), bits);
        fan.lanes[i / kPacketSize] |= uint8_t(bits[0] << i % kPacketSize);
    }
}

DirectionSums sum_directions_target(const RayFan& fan, const V3f& weight_axis)
{
    const FloatTag d;
    const int lanes = int(hn::Lanes(d));
    constexpr int kBlock = 128; // packets: 1024 rays, whose float sum is accurate to about 1e-6
    DirectionSums sums;
    for (int begin = 0; begin < fan.packets; begin += kBlock) {
        const int end = std::min(begin + kBlock, fan.packets);
        auto sx = hn::Zero(d), sy = hn::Zero(d), sz = hn::Zero(d);
        auto wx = hn::Zero(d), wy = hn::Zero(d), wz = hn::Zero(d), weight = hn::Zero(d);
        for (int i = begin * kPacketSize; i < end * kPacketSize; i += lanes) {
            const uint8_t bits[8] = { uint8_t(fan.lanes[i / kPacketSize] >> i % kPacketSize) };
            const auto set = hn::LoadMaskBits(d, bits);
            const auto x = hn::IfThenElseZero(set, hn::LoadU(d, fan.x + i));
            const auto y = hn::IfThenElseZero(set, hn::LoadU(d, fan.y + i));
            const auto z = hn::IfThenElseZero(set, hn::LoadU(d, fan.z + i));
            const auto cosine
                = hn::Add(hn::Add(hn::Mul(x, hn::Set(d, weight_axis.x)), hn::Mul(y, hn::Set(d, weight_axis.y))),
                          hn::Mul(z, hn::Set(d, weight_axis.z)));
            sx = hn::Add(sx, x), sy = hn::Add(sy, y), sz = hn::Add(sz, z);
            wx = hn::Add(wx, hn::Mul(x, cosine)), wy = hn::Add(wy, hn::Mul(y, cosine));
            wz = hn::Add(wz, hn::Mul(z, cosine)), weight = hn::Add(weight, cosine);
        }
        const auto total = [&](FloatVec v) { return double(hn::GetLane(hn::SumOfLanes(d, v))); };
        sums.sum += Imath::V3d(total(sx), total(sy), total(sz));
        sums.weighted_sum += Imath::V3d(total(wx), total(wy), total(wz));
        sums.weight += total(weight);
    }
    for (uint8_t bits : fan.lanes)
        sums.rays += __builtin_popcount(bits);
    return sums;
}

} // namespace HWY_NAMESPACE
} // namespace vmlight::kernel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vmlight::kernel {

HWY_EXPORT(strand_directions_target);
HWY_EXPORT(directions_target);
HWY_EXPORT(sum_directions_target);

void strand_directions(const Points& points, const StrandAngles& angles, const TangentFrame& frame, RayFan& fan)
{
    HWY_DYNAMIC_DISPATCH(strand_directions_target)(points, angles, frame, fan);
}

void directions(const Points& points, const TangentFrame& frame, const Imath::V3f& geometric_normal, RayFan& fan)
{
    HWY_DYNAMIC_DISPATCH(directions_target)(points, frame, geometric_normal, fan);
}

DirectionSums sum_directions(const RayFan& fan, const Imath::V3f& weight_axis)
{
    return HWY_DYNAMIC_DISPATCH(sum_directions_target)(fan, weight_axis);
}

} // namespace vmlight::kernel
#endif
