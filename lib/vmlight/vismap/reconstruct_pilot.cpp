// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/reconstruct_pilot.h>

#include <vmlight/base/parallel.h>
#include <vmlight/math/sampling.h>
#include <vmlight/vismap/ground_of.h>
#include <vmlight/vismap/reconstruct.h>
#include <vmlight/vismap/visibility_integrator.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>

namespace vmlight {
namespace {

// Rays of a probe, in those of a texel.
constexpr int kProbeRays = 8;
constexpr int kMostProbeRays = 1 << 20;
// Between two progress checks, of the windows.
constexpr int kRaysPerGroup = 1 << 18;

} // namespace

ReconstructPilot::ReconstructPilot(const BakeScene& scene, const VismapPilot& pilot, const VismapParams& params,
                                   int nthreads, const Progress& progress)
    : m_scene(scene)
    , m_pilot(pilot)
    , m_params(params)
    , m_threads(nthreads)
    , m_progress([progress](double) { return !progress || progress(0); })
{
    m_params.channels = { "error" };
    m_params.basis = "vector";
    m_params.sun_directions.clear();
}

int64_t ReconstructPilot::traced_texels() const
{
    return int64_t(m_traced.size()) + 2 * kProbeRays * int64_t(m_middles.size());
}

bool ReconstructPilot::trace(std::vector<Visibility>& dst, const std::vector<const Texel*>& texels,
                             const SamplePattern& pattern, int seed, bool is_independent) const
{
    VismapParams params = m_params;
    params.seed = seed;
    const GroundPlane ground = ground_of(m_scene, params);
    std::vector<std::unique_ptr<VisibilityIntegrator>> integrators(static_cast<size_t>(worker_count(m_threads)));
    for (auto& integrator : integrators)
        integrator = std::make_unique<VisibilityIntegrator>(m_scene.occluder(), pattern, params, m_scene.frame().scale,
                                                            ground);
    dst.resize(texels.size());
    const size_t group = size_t(std::max(1, kRaysPerGroup / pattern.count()));
    const auto work = [&](int64_t item, int worker) {
        const size_t first = size_t(item) * group, last = std::min(texels.size(), first + group);
        for (size_t k = first; k < last; ++k) {
            const Texel& texel = *texels[k];
            const Point32 shift = is_independent ? texel_hash(uint32_t(texel.x), uint32_t(texel.y), uint32_t(seed))
                                                 : pattern.texel(texel.x, texel.y, uint32_t(seed));
            dst[k] = integrators[size_t(worker)]->integrate(texel.point, shift, texel.open);
        }
    };
    return parallel_items(int64_t((texels.size() + group - 1) / group), m_threads, work, m_progress);
}

bool ReconstructPilot::measure(const PilotError& plain, double pattern_error, ReconstructError& dst) const
{
    const int samples = plain.samples;
    constexpr int kAcross = NeighbourWindow::kSide / kSide;
    const auto most = size_t(std::clamp(kRaysPerGroup / (kSide * kSide * samples), 1, kAcross * kAcross));
    const int probe_samples = std::max(samples, std::min(samples * kProbeRays, kMostProbeRays));
    const SamplePattern pattern(m_params.sampler, samples, false), probe(m_params.sampler, probe_samples, false);
    std::array<std::vector<Visibility>, 3> seen; // by the windows, and twice by their middles
    for (size_t k = 0; k < seen.size(); ++k) { // no user seed has the highest bit set
        const int seed = int(texel_hash(uint32_t(samples), uint32_t(k) + 1, uint32_t(m_params.seed)).u | 0x80000000u);
        if (!trace(seen[k], k ? m_middles : m_traced, k ? probe : pattern, seed, k > 0))
            return false;
    }
    std::vector<std::unique_ptr<Reconstruction>> reconstructions(static_cast<size_t>(worker_count(m_threads)));
    for (auto& reconstruction : reconstructions)
        reconstruction = std::make_unique<Reconstruction>(m_params, pattern_error);
    struct Sums
    {
        double squares = 0, plain = 0, fourth = 0, expected = 0, texels = 0;
    };
    std::vector<Sums> sums((m_windows.size() + most - 1) / most);
    // As many windows as fit are reconstructed as if they were one tile: no texel reaches into the next window.
    const auto work = [&](int64_t group, int index) {
        Reconstruction& reconstruction = *reconstructions[size_t(index)];
        constexpr int kHalo = NeighbourWindow::kHalo, kChannels = 5;
        constexpr size_t kPitch = size_t(kTileSize) * kChannels;
        std::vector<float> raw(kPitch * kTileSize);
        TexelContexts contexts(0, 0, kTileSize, kTileSize);
        reconstruction.clear();
        const size_t first = size_t(group) * most, last = std::min(m_windows.size(), first + most);
        const auto slot = [&](size_t window, int i) {
            return Imath::V2i(int((window - first) % kAcross) * kSide + i % kSide - kHalo,
                              int((window - first) / kAcross) * kSide + i / kSide - kHalo);
        };
        for (size_t k = first; k < last; ++k)
            for (int i = 0; i < kSide * kSide; ++i) {
                const Texel& texel = m_windows[k].texels[size_t(i)];
                if (texel.spacing == 0)
                    continue;
                const Visibility& own = seen[0][m_windows[k].traced[size_t(i)]];
                const TexelContext context { texel.point.near_origin, texel.point.normal, texel.spacing,
                                             float(own.error * own.error) };
                const std::array<float, kChannels> channels { float(own.visibility), float(own.direction.x),
                                                              float(own.direction.y), float(own.direction.z), 0 };
                const Imath::V2i at = slot(k, i);
                reconstruction.add(at.x, at.y, channels.data(), context);
                if (at.x < 0 || at.y < 0 || at.x >= kTileSize || at.y >= kTileSize)
                    continue;
                contexts.at(at.x, at.y) = context;
                std::copy(channels.begin(), channels.end(),
                          raw.begin() + int64_t(size_t(at.y) * kPitch + size_t(at.x) * kChannels));
            }
        std::vector<float> texels = raw;
        reconstruction.apply(raw.data(), texels.data(), kPitch, 0, 0, contexts);
        Sums& sum = sums[size_t(group)];
        for (size_t k = first; k < last; ++k) {
            const Texel& texel = m_windows[k].texels[kMiddle];
            if (texel.spacing == 0)
                continue;
            const Imath::V2i at = slot(k, kMiddle);
            const size_t channel = size_t(at.y) * kPitch + size_t(at.x) * kChannels;
            double square = 1, plain_square = 1;
            for (size_t p = 1; p < 3; ++p) {
                const double truth = seen[p][m_middle_of[m_windows[k].traced[kMiddle]]].visibility;
                square *= double(texels[channel]) - truth;
                plain_square *= double(raw[channel]) - truth;
            }
            const double counts = m_windows[k].counts;
            sum.plain += counts * plain_square;
            sum.squares += counts * square;
            sum.fourth += counts * counts * square * square;
            sum.expected += counts * double(texels[channel + 4]) * double(texels[channel + 4]);
            sum.texels += counts;
        }
    };
    if (!parallel_items(int64_t(sums.size()), m_threads, work, m_progress))
        return false;
    Sums all;
    for (const Sums& sum : sums) {
        all.squares += sum.squares;
        all.plain += sum.plain;
        all.fourth += sum.fourth;
        all.expected += sum.expected;
        all.texels += sum.texels;
    }
    const double count = all.texels > 0 ? all.texels : 1;
    // Where chance makes the estimate negative, its standard error is all that is known.
    const double square = all.squares > 0 ? all.squares / count : std::sqrt(all.fourth) / count;
    // In proportion to the error without reconstruction, which is known from more texels: windows happen to lie where
    // errors are large, or small.
    dst.rms = all.plain > 0 ? plain.rms * std::sqrt(square * count / all.plain) : std::sqrt(square);
    dst.scale = all.expected > 0 ? std::sqrt(square * count / all.expected) : 1;
    return true;
}

} // namespace vmlight
