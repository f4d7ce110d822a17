// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/basis.h>

#include <vmlight/image/channels.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <array>

namespace vmlight {
namespace {

constexpr int kLanes = Harmonics::kLanes;
static_assert(kLanes == kPacketSize, "a packet is evaluated at once");
// Packets summed in float before the sum goes on in double.
constexpr int kBlock = 128;

int basis_count(const VismapParams& params)
{
    return params.basis == "sh"   ? params.order * params.order - 4
        : params.basis == "mask"  ? kMaskFloats
        : params.basis == "cells" ? kCellsFloats
                                  : 0;
}

} // namespace

std::vector<std::string> basis_channels(const VismapParams& params)
{
    const char* prefix = params.basis == "sh" ? kHarmonicChannel
        : params.basis == "mask"              ? kMaskChannel
                                              : kCellsChannel;
    std::vector<std::string> names;
    for (int i = 0; i < basis_count(params); ++i)
        names.push_back(OIIO::Strutil::fmt::format("{}{}", prefix, params.basis == "sh" ? i + 4 : i));
    return names;
}

bool is_linear_basis(const VismapParams& params)
{
    return params.basis != "mask" && params.basis != "cells";
}

VisibilityBasis::VisibilityBasis(const VismapParams& params)
    : m_basis(params.basis)
    , m_count(basis_count(params))
{
    if (m_basis == "sh") {
        m_harmonics = std::make_unique<Harmonics>(params.order);
        const size_t count = size_t(m_harmonics->count());
        m_values.resize(count * kLanes);
        m_seen_lanes.resize(count * kLanes);
        m_all_lanes.resize(count * kLanes);
        m_seen.resize(count);
        m_all.resize(count);
    } else if (m_count > 0) {
        m_grid = std::make_unique<VisibilityGrid>();
    }
}

void VisibilityBasis::project(const RayFan& fan, const std::vector<uint8_t>& asked, bool whole,
                              const Imath::V3f& normal, const Imath::V3f& surface, double visibility, float* dst)
{
    if (m_harmonics)
        return project_harmonics(fan, asked, whole, normal, visibility, dst);
    if (!m_grid)
        return;
    m_grid->take(fan, asked);
    m_basis == "mask" ? m_grid->mask(dst, Imath::V3d(normal), Imath::V3d(surface))
                      : m_grid->cells(dst, Imath::V3d(normal), Imath::V3d(surface));
}

void VisibilityBasis::project_harmonics(const RayFan& fan, const std::vector<uint8_t>& asked, bool whole,
                                        const Imath::V3f& normal, double visibility, float* dst)
{
    const int count = m_harmonics->count();
    std::fill(m_seen.begin(), m_seen.end(), 0.0);
    std::fill(m_all.begin(), m_all.end(), 0.0);
    int64_t rays = 0;
    for (int first = 0; first < fan.packets; first += kBlock) {
        std::fill(m_seen_lanes.begin(), m_seen_lanes.end(), 0.0f);
        std::fill(m_all_lanes.begin(), m_all_lanes.end(), 0.0f);
        for (int packet = first; packet < std::min(first + kBlock, fan.packets); ++packet) {
            const size_t ray = size_t(packet) * kLanes;
            std::array<float, kLanes> seen, all;
            for (int i = 0; i < kLanes; ++i) {
                all[size_t(i)] = float(asked[size_t(packet)] >> i & 1);
                seen[size_t(i)] = float(fan.lanes[size_t(packet)] >> i & 1);
                rays += asked[size_t(packet)] >> i & 1;
            }
            m_harmonics->evaluate(fan.x + ray, fan.y + ray, fan.z + ray, m_values.data());
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
    // As for B, what the samples miss of the whole, which is known (a cosine's harmonics are those of the normal times
    // its eigenvalue), they miss of the part that is seen in proportion: exact where all or nothing is.
    std::array<float, kLanes> x, y, z;
    x.fill(normal.x), y.fill(normal.y), z.fill(normal.z);
    m_harmonics->evaluate(x.data(), y.data(), z.data(), m_values.data());
    for (int l = 2; l < m_harmonics->order(); ++l)
        for (int k = l * l; k < (l + 1) * (l + 1); ++k) {
            double value = m_seen[size_t(k)] / double(rays);
            if (whole)
                value += (cosine_eigenvalue(l) * double(m_values[size_t(k * kLanes)]) - m_all[size_t(k)] / double(rays))
                    * visibility;
            dst[k - 4] = visibility > 0 ? float(value) : 0.0f;
        }
}

} // namespace vmlight
