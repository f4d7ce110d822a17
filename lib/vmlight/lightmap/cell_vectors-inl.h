// SPDX-License-Identifier: Apache-2.0
// The vector form of cell_sums.h. Highway includes this anew for each instruction set.
#if defined(VMLIGHT_CELL_VECTORS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VMLIGHT_CELL_VECTORS_INL_H
#undef VMLIGHT_CELL_VECTORS_INL_H
#else
#define VMLIGHT_CELL_VECTORS_INL_H
#endif

#include <vmlight/lightmap/cell_sums.h>

#include <hwy/highway.h>

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace vmlight {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR

namespace hn = hwy::HWY_NAMESPACE;

using Four = hn::FixedTag<float, 4>;
using FourWhole = hn::FixedTag<int32_t, 4>;
using TwoLanes = hn::FixedTag<int64_t, 2>;

// Sums of entries of a table.
#if HWY_MAX_BYTES >= 32 && !HWY_HAVE_SCALABLE
class EntrySum
{
    using All = hn::FixedTag<int64_t, kMomentLanes>;
    hn::Vec<All> m_sum;

public:
    HWY_INLINE EntrySum() // implied, it would not be compiled for the instruction set
        : m_sum(hn::Zero(All()))
    {
    }
    HWY_INLINE void Add(const int64_t* entry) { m_sum = hn::Add(m_sum, hn::Load(All(), entry)); }
    HWY_INLINE void Subtract(const int64_t* entry) { m_sum = hn::Sub(m_sum, hn::Load(All(), entry)); }
    HWY_INLINE hn::Vec<TwoLanes> Lower() const { return hn::LowerHalf(TwoLanes(), m_sum); }
    HWY_INLINE hn::Vec<TwoLanes> Upper() const { return hn::UpperHalf(TwoLanes(), m_sum); }
};
#else
class EntrySum
{
    hn::Vec<TwoLanes> m_lower, m_upper;

public:
    HWY_INLINE EntrySum()
        : m_lower(hn::Zero(TwoLanes()))
        , m_upper(hn::Zero(TwoLanes()))
    {
    }
    HWY_INLINE void Add(const int64_t* entry)
    {
        m_lower = hn::Add(m_lower, hn::Load(TwoLanes(), entry));
        m_upper = hn::Add(m_upper, hn::Load(TwoLanes(), entry + 2));
    }
    HWY_INLINE void Subtract(const int64_t* entry)
    {
        m_lower = hn::Sub(m_lower, hn::Load(TwoLanes(), entry));
        m_upper = hn::Sub(m_upper, hn::Load(TwoLanes(), entry + 2));
    }
    HWY_INLINE hn::Vec<TwoLanes> Lower() const { return m_lower; }
    HWY_INLINE hn::Vec<TwoLanes> Upper() const { return m_upper; }
};
#endif

// The products of n, as x, y, z, 0, with two lanes: x of the first with z, y, and both of the second.
HWY_INLINE hn::Vec<Four> TimesNormal(hn::Vec<TwoLanes> lanes, hn::Vec<Four> n)
{
    const hn::RebindToUnsigned<TwoLanes> du;
    const Four d;
    const FourWhole di;
    constexpr uint64_t kField = (uint64_t(1) << kMomentBits) - 1;
    const auto biased = hn::BitCast(du, hn::Add(lanes, hn::Set(TwoLanes(), kAllBiases)));
    const auto x = hn::And(biased, hn::Set(du, kField));
    const auto y = hn::ShiftLeft<32 - kMomentBits>(hn::And(biased, hn::Set(du, kField << kMomentBits)));
    const auto z = hn::ShiftRight<2 * kMomentBits>(biased);
    const auto bias = hn::Set(d, float(kMomentBias));
    const auto xy = hn::Sub(hn::ConvertTo(d, hn::BitCast(di, hn::Or(x, y))), bias);
    const auto z0 = hn::Sub(hn::ConvertTo(d, hn::BitCast(di, z)), bias);
    return hn::Add(hn::Mul(xy, hn::ConcatLowerLower(d, n, n)), hn::Mul(z0, hn::ConcatUpperUpper(d, n, n)));
}

// Four whole numbers, 0 for those that are not; `good` keeps its bits where all were.
HWY_INLINE hn::Vec<FourWhole> WholeNumbers(const float* packed, hn::Vec<Four>& good)
{
    const Four d;
    const FourWhole di;
    const auto value = hn::LoadU(d, packed);
    const auto fits = hn::And(hn::Ge(value, hn::Zero(d)), hn::Lt(value, hn::Set(d, 0x1p24f)));
    const auto whole = hn::ConvertTo(di, hn::IfThenElseZero(fits, value));
    good = hn::And(good, hn::VecFromMask(d, hn::And(fits, hn::Eq(hn::ConvertTo(d, whole), value))));
    return whole;
}

struct MaskModel : MaskCodes
{
    // Six or four codes of 16 bits, by the bytes that they are made of: the codes of a pair of numbers are its bytes,
    // the highest first. Byte 3 of each number is 0.
    static HWY_INLINE void Decode(hn::Vec<FourWhole> numbers, const uint8_t* bytes, uint16_t* high, uint16_t* low,
                                  hn::Vec<hn::FixedTag<uint16_t, 8>>& angle)
    {
        const hn::FixedTag<uint8_t, 16> d8;
        const hn::FixedTag<uint16_t, 8> d;
        constexpr int kEntry = 2; // 4 numbers
        const auto codes = hn::BitCast(d, hn::TableLookupBytes(hn::BitCast(d8, numbers), hn::Load(d8, bytes)));
        const auto density = hn::And(codes, hn::Set(d, uint16_t(15)));
        const auto high_edge = hn::And(hn::ShiftRight<4>(codes), hn::Set(d, uint16_t(63)));
        const auto low_edge = hn::ShiftRight<10>(codes);
        hn::Store(hn::ShiftLeft<kEntry>(hn::And(codes, hn::Set(d, uint16_t(1023)))), d, high);
        hn::Store(hn::ShiftLeft<kEntry>(hn::Or(hn::ShiftLeft<4>(low_edge), density)), d, low);
        angle = hn::Add(angle, hn::Mul(hn::Sub(high_edge, low_edge), density));
    }

    static HWY_INLINE float Sum(const CellLight& light, const float* packed, EntrySum& sum, hn::Vec<Four>& good)
    {
        HWY_ALIGN static constexpr uint8_t kSix[16] = { 1, 2, 6, 0, 4, 5, 9, 10, 14, 8, 12, 13, 3, 3, 3, 3 };
        HWY_ALIGN static constexpr uint8_t kFour[16] = { 5, 6, 10, 4, 8, 9, 13, 14, 3, 3, 3, 3, 3, 3, 3, 3 };
        const FourWhole di;
        HWY_ALIGN uint16_t high[24], low[24];
        auto angles = hn::Zero(hn::FixedTag<uint16_t, 8>());
        Decode(WholeNumbers(packed, good), kSix, high, low, angles);
        Decode(WholeNumbers(packed + 4, good), kSix, high + 8, low + 8, angles);
        Decode(WholeNumbers(packed + 7, good), kFour, high + 16, low + 16, angles); // the first is not used again
        const int64_t* part = light.moments.data()->lanes;
        for (int column = 0; column < direction_grid::kColumns; ++column, part += 4 * kMaskStride) {
            const int at = column / 6 * 8 + column % 6;
            sum.Add(part + high[at]);
            sum.Subtract(part + low[at]);
        }
        // Both halves of each number, with their signs.
        const auto two = hn::BitCast(di, angles);
        const auto both = hn::Add(hn::ShiftRight<16>(hn::ShiftLeft<16>(two)), hn::ShiftRight<16>(two));
        return float(hn::GetLane(hn::SumOfLanes(di, both)));
    }
};

struct CellsModel : CellsCodes
{
    static HWY_INLINE float Sum(const CellLight& light, const float* packed, EntrySum& sum, hn::Vec<Four>& good)
    {
        const FourWhole di;
        HWY_ALIGN int32_t codes[kCellsFloats];
        auto angles = hn::Zero(di);
        for (int i = 0; i < kCellsFloats; i += 4) {
            const auto four = WholeNumbers(packed + i, good);
            hn::Store(four, di, codes + i);
            // Sums of two thirds, then of four, in each byte.
            const auto pairs = hn::Set(di, 0x333333), bytes = hn::Set(di, 0x0f0f0f);
            const auto two = hn::Add(hn::And(four, pairs), hn::And(hn::ShiftRight<2>(four), pairs));
            angles = hn::Add(angles, hn::Add(hn::And(two, bytes), hn::And(hn::ShiftRight<4>(two), bytes)));
        }
        const int64_t* part = light.moments.data()->lanes;
        for (int i = 0; i < kCellsFloats; ++i, part += 3 * 4 * kCellsStride)
            if (const uint32_t code = uint32_t(codes[i])) { // often no cell of a part of the sphere is visible
                sum.Add(part + 4 * (code >> 16));
                sum.Add(part + 4 * (kCellsStride + (code >> 8 & 255)));
                sum.Add(part + 4 * (2 * kCellsStride + (code & 255)));
            }
        const int32_t angle = hn::GetLane(hn::SumOfLanes(di, angles));
        return float((angle & 255) + (angle >> 8 & 255) + (angle >> 16));
    }
};

// What is known of the texels of a block before their light.
struct CellBlock
{
    static constexpr size_t kTexels = 128;
    HWY_ALIGN float visibility[kTexels], size[kTexels], angle[kTexels], even[kTexels];
    HWY_ALIGN float plain[3][kTexels];
    HWY_ALIGN float normal[4 * kTexels]; // x, y, z and a 0, of unit length
    HWY_ALIGN float along[4 * kTexels]; // R, G, B and the weight, in fixed point
};

template <class D> HWY_INLINE void ReadNormals(D d, const float* vismap, int floats, size_t count, CellBlock& block)
{
    HWY_ALIGN float axes[3][CellBlock::kTexels];
    const size_t lanes = hn::Lanes(d);
    for (size_t i = 0; i < count; ++i, vismap += floats) {
        block.visibility[i] = vismap[0];
        for (int axis = 0; axis < 3; ++axis)
            axes[axis][i] = vismap[4 + axis];
    }
    for (size_t i = count; i % lanes; ++i)
        block.visibility[i] = axes[0][i] = axes[1][i] = axes[2][i] = block.angle[i] = 0;
    for (size_t i = 0; i < count; i += lanes) {
        const auto x = hn::Load(d, axes[0] + i), y = hn::Load(d, axes[1] + i), z = hn::Load(d, axes[2] + i);
        const auto size = hn::Sqrt(hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z)));
        const auto unit = hn::IfThenElseZero(hn::Gt(size, hn::Zero(d)), hn::Div(hn::Set(d, 1.0f), size));
        hn::Store(size, d, block.size + i);
        hn::StoreInterleaved4(hn::Mul(x, unit), hn::Mul(y, unit), hn::Mul(z, unit), hn::Zero(d), d,
                              block.normal + 4 * i);
    }
}

// How far texels of a group look away from what they see, in `even`; their sums without w, where that counts.
template <class Model, class D, class V = hn::Vec<D>>
HWY_INLINE V Even(D d, const CellLight& light, V weight, size_t i, const float* vismap, size_t count, CellBlock& block)
{
    const V angle = hn::Load(d, block.angle + i), least = hn::Set(d, kLeastCosine);
    const V cosine = hn::IfThenElseZero(hn::Gt(angle, hn::Zero(d)), hn::Div(weight, angle));
    const V even
        = hn::IfThenElseZero(hn::Lt(cosine, least), hn::Mul(hn::Sub(least, cosine), hn::Set(d, 1 / kLeastCosine)));
    for (int c = 0; c < 3; ++c)
        hn::Store(hn::Zero(d), d, block.plain[c] + i);
    if (hn::AllFalse(d, hn::Gt(even, hn::Zero(d))))
        return even;
    hn::Store(even, d, block.even + i);
    for (size_t k = i; k < std::min(i + hn::Lanes(d), count); ++k)
        if (block.even[k] > 0) {
            uint32_t codes[Model::kFloats];
            float plain[3] = { 0, 0, 0 };
            whole_numbers<Model::kFloats>(vismap + k * (kBeforePacked + Model::kFloats) + kBeforePacked, codes);
            Model::sum_plain(light, codes, plain);
            for (int c = 0; c < 3; ++c)
                block.plain[c][k] = plain[c];
        }
    return even;
}

template <class Model>
HWY_INLINE bool ShadeTexels(const CellLight& light, const ShadeSetup& setup, const float* vismap, size_t texels,
                            float* rgb)
{
    constexpr int kFloats = kBeforePacked + Model::kFloats;
    const hn::CappedTag<float, 16> d;
    using V = hn::Vec<decltype(d)>;
    const size_t lanes = hn::Lanes(d);
    const Four four;
    CellBlock block;
    HWY_ALIGN float tail[3 * hn::MaxLanes(d)];
    auto good = hn::VecFromMask(four, hn::Eq(hn::Zero(four), hn::Zero(four)));
    auto sound = hn::Eq(hn::Zero(d), hn::Zero(d));
    for (size_t begin = 0; begin < texels; begin += CellBlock::kTexels) {
        const size_t count = std::min(texels - begin, CellBlock::kTexels);
        const float* vm = vismap + begin * kFloats;
        ReadNormals(d, vm, kFloats, count, block);
        for (size_t i = 0; i < count; ++i) {
            EntrySum sum;
            block.angle[i] = Model::Sum(light, vm + i * kFloats + kBeforePacked, sum, good) * Model::kAngle;
            const auto n = hn::Load(four, block.normal + 4 * i);
            const auto lower = TimesNormal(sum.Lower(), n), upper = TimesNormal(sum.Upper(), n);
            hn::Store(hn::Add(hn::ConcatEven(four, upper, lower), hn::ConcatOdd(four, upper, lower)), four,
                      block.along + 4 * i);
        }
        for (size_t i = 4 * count; i % (4 * lanes); ++i)
            block.along[i] = 0;
        for (size_t i = 0; i < count; i += lanes) {
            V along[kMomentLanes];
            hn::LoadInterleaved4(d, block.along + 4 * i, along[0], along[1], along[2], along[3]);
            for (int lane = 0; lane < kMomentLanes; ++lane)
                along[lane] = hn::Mul(along[lane], hn::Set(d, light.unit[lane]));
            const V even = Even<Model>(d, light, along[3], i, vm, count, block);
            const V v = hn::Load(d, block.visibility + i), gain = hn::Mul(v, hn::Set(d, setup.gain));
            const V weight = hn::Add(along[3], hn::Mul(even, hn::Load(d, block.angle + i)));
            const V share = hn::IfThenElseZero(hn::Gt(weight, hn::Zero(d)), hn::Div(hn::Set(d, 1.0f), weight));
            const V size = hn::Load(d, block.size + i);
            // x - x is 0 for finite x and NaN for others.
            sound = hn::And(
                sound,
                hn::And(hn::Le(hn::Abs(v), hn::Set(d, kLargestVisibility)), hn::Eq(hn::Sub(size, size), hn::Zero(d))));
            for (int c = 0; c < 3; ++c) {
                const V least = hn::Set(d, light.least[c]), most = hn::Set(d, light.most[c]);
                const V mean
                    = hn::Add(hn::Set(d, light.mean[c]),
                              hn::Mul(hn::Add(along[c], hn::Mul(even, hn::Load(d, block.plain[c] + i))), share));
                const V color = hn::Mul(
                    gain, hn::IfThenElse(hn::Lt(mean, least), least, hn::IfThenElse(hn::Gt(mean, most), most, mean)));
                const auto finite = hn::Eq(hn::Sub(color, color), hn::Zero(d));
                sound = hn::And(sound, finite);
                const V brightest = hn::Set(d, light.brightest[c] * setup.gain * kAboveRounding);
                const V held = hn::IfThenElse(hn::And(hn::Gt(color, brightest), finite), brightest, color);
                along[c] = hn::IfThenZeroElse(hn::Le(gain, hn::Zero(d)), held);
            }
            if (i + lanes <= count) {
                hn::StoreInterleaved3(along[0], along[1], along[2], d, rgb + 3 * (begin + i));
            } else {
                hn::StoreInterleaved3(along[0], along[1], along[2], d, tail);
                std::copy_n(tail, 3 * (count - i), rgb + 3 * (begin + i));
            }
        }
    }
    return hn::AllTrue(d, sound) && hn::AllTrue(four, hn::MaskFromVec(good));
}

#endif

} // namespace HWY_NAMESPACE
} // namespace vmlight
HWY_AFTER_NAMESPACE();

#endif
