// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/strand_map.h>

#include <vmlight/base/available_memory.h>
#include <vmlight/base/fail_with.h>
#include <vmlight/base/format.h>
#include <vmlight/base/parallel.h>
#include <vmlight/base/tile_size.h>
#include <vmlight/image/channels.h>
#include <vmlight/image/color.h>
#include <vmlight/math/harmonics.h>
#include <vmlight/mesh/strand_curve.h>
#include <vmlight/version.h>
#include <vmlight/vismap/basis.h>
#include <vmlight/vismap/strand_order.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <optional>
#include <vector>

namespace vmlight {
namespace {

using Imath::V3d;
using Imath::V3f;

constexpr int kStrandChannels = 7;
constexpr int64_t kStrandsAtOnce = 16; // strands that a thread bakes at a time

// Of VismapParams, and those of the recipe that say what is read.
constexpr const char* kStrandKeys[]
    = { "mesh", "occluder", "radius",       "strand_texels", "up",   "cutouts", "frame",
        "fps",  "samples",  "max_distance", "sampler",       "seed", "basis",   "order" };

} // namespace

bool is_strand_parameter(const std::string& key)
{
    return std::find(std::begin(kStrandKeys), std::end(kStrandKeys), key) != std::end(kStrandKeys);
}

bool StrandLayout::make(StrandLayout& dst, size_t strands, int texels, std::string& error)
{
    constexpr double kLongestSide = 32768;
    const double square = std::ceil(std::sqrt(double(strands) * texels) / kTileSize) * kTileSize;
    const double rows = std::min(double(strands), square);
    const double width = rows > 0 ? std::ceil(double(strands) / rows) * texels : 0;
    if (rows > kLongestSide || width > kLongestSide) {
        error = format("strand_texels: {} strands of {} texels make a map of {}x{}; a side is at most {}", strands,
                       texels, width, rows, kLongestSide);
        return false;
    }
    dst = { int64_t(strands), texels, int(rows) };
    return true;
}

Size StrandLayout::size() const
{
    return { int((strands + rows - 1) / rows) * texels, rows };
}

int64_t StrandLayout::strand_at(int x, int y) const
{
    return std::min(strands, int64_t(x / texels) * rows + y);
}

OIIO::ROI StrandLayout::roi(int64_t strand) const
{
    const int x = int(strand / rows) * texels, y = int(strand % rows);
    return { x, x + texels, y, y + 1, 0, 1 };
}

Imath::V2d StrandLayout::uv(int64_t strand, double share) const
{
    const Size map = size();
    const double along = std::clamp(share * texels, 0.5, texels - 0.5);
    return { (double(strand / rows) * texels + along) / map.width, 1 - (double(strand % rows) + 0.5) / map.height };
}

std::vector<Imath::V2f> strand_uvs(const Strands& strands, const StrandLayout& layout)
{
    std::vector<Imath::V2f> uvs;
    for (size_t strand = 0; strand < strands.count(); ++strand)
        for (const double share : StrandCurve(strands, strand).knot_shares())
            uvs.emplace_back(layout.uv(int64_t(strand), share));
    return uvs;
}

OIIO::ImageSpec describe_strand_map(const Strands& strands, const StrandLayout& layout,
                                    const StrandParams& strand_params, const VismapParams& params)
{
    std::vector<std::string> names(kVismapChannels.begin(), kVismapChannels.end());
    names.insert(names.end(), kTangentChannels.begin(), kTangentChannels.end());
    const std::vector<std::string> basis = basis_channels(params);
    names.insert(names.end(), basis.begin(), basis.end());
    const Size size = layout.size();
    OIIO::ImageSpec spec(size.width, size.height, int(names.size()), OIIO::TypeDesc::FLOAT);
    spec.channelnames = names;
    spec.tile_width = spec.tile_height = kTileSize;
    spec.tile_depth = 1;
    tag_data(spec);
    VismapParams all = params;
    all.visit([&](const char* key, auto& value, const auto& allowed, const char*) {
        if (is_strand_parameter(key))
            spec.attribute(metadata_name(key), value_text(value, allowed));
    });
    append_params(spec, strand_params);
    if (strand_params.radius.empty())
        spec.erase_attribute("vmlight:radius");
    spec.attribute("vmlight:kernel", kStrandKernel);
    spec.attribute("vmlight:strands", std::to_string(layout.strands));
    spec.attribute("vmlight:stage", kVismapStage);
    spec.attribute("vmlight:version", VMLIGHT_VERSION_STRING);
    spec.attribute("vmlight:mesh", strands.name);
    spec.attribute("vmlight:meshHash", strands_hash(strands));
    return spec;
}

/// What a thread needs for one point at a time.
class StrandBaker::Point
{
public:
    explicit Point(const StrandBaker& baker)
        : m_baker(baker)
        , m_fan(baker.m_pattern.count())
        , m_basis(make_accumulator(baker.m_params))
    {
    }

    void bake(const CurvePoint& point, int64_t strand, Point32 texel, float* dst)
    {
        const SceneFrame& frame = m_baker.m_scene.frame();
        const V3f tangent(point.tangent);
        m_baker.m_pattern.directions(m_fan, tangent, texel);
        m_traced = m_fan.lanes;
        const DirectionSums all = sum_directions(m_fan, tangent);
        m_baker.m_scene.clear_blocked(m_fan, frame.to_scene(point.position), float(point.radius * frame.scale),
                                      uint32_t(strand), float(m_baker.m_params.max_distance * frame.scale));
        const DirectionSums seen = sum_directions(m_fan, tangent);
        const double rays = double(all.rays), visibility = double(seen.rays) / rays;
        // A control variate: the mean of all directions is 0, and the rays' error in it is removed from the visible
        // part in proportion. Exact where all or nothing is visible.
        V3d direction = seen.rays > 0 ? (seen.sum - all.sum * visibility) / rays : V3d(0);
        double narrowed = 1;
        if (direction.length() > visibility) {
            narrowed = visibility / direction.length();
            direction *= narrowed;
        }
        *dst++ = float(visibility);
        for (const V3d& v : { direction, V3d(tangent) })
            for (int axis = 0; axis < 3; ++axis)
                *dst++ = float(v[axis]);
        if (m_basis)
            m_basis->project({ m_fan, m_traced, true, tangent, tangent, visibility, narrowed, sine_eigenvalue }, dst);
    }

private:
    const StrandBaker& m_baker;
    RayFan m_fan;
    std::vector<uint8_t> m_traced; // lane bits before the rays are traced
    std::unique_ptr<BasisAccumulator> m_basis;
};

StrandBaker::StrandBaker(const Strands& strands, const StrandScene& scene, const StrandLayout& layout,
                         const VismapParams& params)
    : m_strands(strands)
    , m_scene(scene)
    , m_layout(layout)
    , m_params(params)
    , m_pattern(params.sampler, params.samples)
    , m_basis_count(int(basis_channels(params).size()))
{
}

int64_t StrandBaker::bake(OIIO::ROI roi, float* dst) const
{
    const int channels = kStrandChannels + m_basis_count;
    std::fill_n(dst, size_t(roi.width()) * size_t(roi.height()) * size_t(channels), 0.0f);
    Point point(*this);
    int64_t rays = 0;
    for (int y = roi.ybegin; y < roi.yend; ++y) {
        std::optional<StrandCurve> curve;
        int64_t strand = -1;
        for (int x = roi.xbegin; x < roi.xend; ++x, dst += channels) {
            const int64_t here = m_layout.strand_at(x, y);
            if (here == m_layout.strands)
                continue;
            if (here != strand)
                curve.emplace(m_strands, size_t(here));
            strand = here;
            point.bake(curve->at(m_layout.share_at(x)), strand,
                       texel_hash(uint32_t(x), uint32_t(y), uint32_t(m_params.seed)), dst);
            rays += m_pattern.count();
        }
    }
    return rays;
}

bool make_strand_map(OIIO::ImageBuf& dst, const OIIO::ImageSpec& spec, const StrandBaker& baker, int nthreads,
                     int64_t& rays, const Progress& progress)
{
    const std::string shortage = memory_shortage(spec);
    if (!shortage.empty())
        return fail_with(dst, shortage);
    dst.reset(spec, OIIO::InitializePixels::No);
    auto* const pixels = static_cast<float*>(dst.localpixels());
    if (!pixels)
        return fail_with(dst, format("out of memory for {}x{} texels", spec.width, spec.height));
    std::atomic<int64_t> traced { 0 };
    std::fill_n(pixels, size_t(spec.image_pixels()) * size_t(spec.nchannels), 0.0f);
    const std::vector<uint32_t> order = strands_by_place(baker.strands());
    const auto count = int64_t(order.size());
    const auto bake_block = [&](int64_t block, int) {
        for (int64_t i = block * kStrandsAtOnce; i < std::min(count, (block + 1) * kStrandsAtOnce); ++i) {
            const OIIO::ROI roi = baker.layout().roi(order[size_t(i)]);
            traced += baker.bake(roi, pixels + spec.nchannels * (int64_t(roi.ybegin) * spec.width + roi.xbegin));
        }
    };
    if (!parallel_items((count + kStrandsAtOnce - 1) / kStrandsAtOnce, nthreads, bake_block, progress))
        return fail_with(dst, "interrupted");
    rays = traced;
    return true;
}

} // namespace vmlight
