// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/basis_sh.h>

#include <vmlight/image/channels.h>
#include <vmlight/math/harmonics.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vmlight {
namespace {

constexpr int kLanes = Harmonics::kLanes;
static_assert(kLanes == kPacketSize, "a packet is evaluated at once");
// Packets summed in float before the sum goes on in double.
constexpr int kBlock = 128;

class HarmonicAccumulator : public BasisAccumulator
{
public:
    explicit HarmonicAccumulator(int bands)
        : m_harmonics(bands)
        , m_values(size_t(m_harmonics.count()) * kLanes)
        , m_seen_lanes(m_values.size())
        , m_all_lanes(m_values.size())
        , m_seen(size_t(m_harmonics.count()))
        , m_all(m_seen.size())
    {
    }
    void project(const TexelRays& rays, float* dst) override;

private:
    const Harmonics m_harmonics;
    std::vector<float> m_values, m_seen_lanes, m_all_lanes;
    std::vector<double> m_seen, m_all;
};

void HarmonicAccumulator::project(const TexelRays& rays, float* dst)
{
    const RayFan& fan = rays.fan;
    const int count = m_harmonics.count();
    std::fill(m_seen.begin(), m_seen.end(), 0.0);
    std::fill(m_all.begin(), m_all.end(), 0.0);
    int64_t traced = 0;
    for (int first = 0; first < fan.packets; first += kBlock) {
        std::fill(m_seen_lanes.begin(), m_seen_lanes.end(), 0.0f);
        std::fill(m_all_lanes.begin(), m_all_lanes.end(), 0.0f);
        for (int packet = first; packet < std::min(first + kBlock, fan.packets); ++packet) {
            const size_t ray = size_t(packet) * kLanes;
            std::array<float, kLanes> seen, all;
            for (int i = 0; i < kLanes; ++i) {
                all[size_t(i)] = float(rays.traced[size_t(packet)] >> i & 1);
                seen[size_t(i)] = float(fan.lanes[size_t(packet)] >> i & 1);
                traced += rays.traced[size_t(packet)] >> i & 1;
            }
            m_harmonics.evaluate(fan.x + ray, fan.y + ray, fan.z + ray, m_values.data());
            for (size_t k = 0; k < size_t(count) * kLanes; k += kLanes)
                for (size_t i = 0; i < kLanes; ++i) {
                    m_all_lanes[k + i] += all[i] * m_values[k + i];
                    m_seen_lanes[k + i] += seen[i] * m_values[k + i];
                }
        }
        for (int k = 0; k < count; ++k)
            for (int i = 0; i < kLanes; ++i) {
                m_all[size_t(k)] += double(m_all_lanes[size_t(k * kLanes + i)]);
                m_seen[size_t(k)] += double(m_seen_lanes[size_t(k * kLanes + i)]);
            }
    }
    // A control variate, as for B: the harmonics of the whole lobe are known (those of the normal times the
    // lobe's eigenvalue), and the rays' error in them is removed from the visible part in proportion. Exact where
    // all or nothing is visible.
    std::array<float, kLanes> x, y, z;
    x.fill(rays.normal.x), y.fill(rays.normal.y), z.fill(rays.normal.z);
    m_harmonics.evaluate(x.data(), y.data(), z.data(), m_values.data());
    // Where B was too long the bands above are too large as well. They shrink as by a blur of the sphere, which scales
    // band l by the power l (l + 1) / 2 of what it scales B by, and makes nothing negative.
    for (int l = 2; l < m_harmonics.order(); ++l) {
        const double blur = std::pow(rays.narrowed, 0.5 * l * (l + 1));
        for (int k = l * l; k < (l + 1) * (l + 1); ++k) {
            double value = m_seen[size_t(k)] / double(traced);
            if (rays.complete)
                value += (rays.eigenvalue(l) * double(m_values[size_t(k * kLanes)]) - m_all[size_t(k)] / double(traced))
                    * rays.visibility;
            dst[k - 4] = rays.visibility > 0 ? float(value * blur) : 0.0f;
        }
    }
}

} // namespace

std::vector<std::string> sh_channels(const VismapParams& params)
{
    return numbered_channels("sh", 4, params.order * params.order);
}

std::unique_ptr<BasisAccumulator> make_sh_accumulator(const VismapParams& params)
{
    return std::make_unique<HarmonicAccumulator>(params.order);
}

} // namespace vmlight
