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

bool ReconstructPilot::measure(const PilotError& plain, double pattern_error, ReconstructError& dst) const
{
    const int samples = plain.samples;
    constexpr int kAcross = NeighbourWindow::kSide / kSide;
    const auto most = size_t(std::clamp(kRaysPerGroup / (kSide * kSide * samples), 1, kAcross * kAcross));
    const int probe_samples = std::max(samples, std::min(samples * kProbeRays, kMostProbeRays));
    const SamplePattern pattern(m_params.sampler, samples, false), probe(m_params.sampler, probe_samples, false);
    std::array<VismapParams, 3> params { m_params, m_params, m_params };
    for (size_t k = 0; k < params.size(); ++k) // no user seed has the highest bit set
        params[k].seed = int(texel_hash(uint32_t(samples), uint32_t(k) + 1, uint32_t(m_params.seed)).u | 0x80000000u);
    const GroundPlane ground = ground_of(m_scene, m_params);
    const double units = m_scene.frame().scale;

    struct Worker
    {
        std::array<std::unique_ptr<VisibilityIntegrator>, 3> integrators;
        std::unique_ptr<Reconstruction> reconstruction;
    };
    std::vector<Worker> workers(static_cast<size_t>(worker_count(m_threads)));
    for (Worker& worker : workers) {
        for (size_t k = 0; k < 3; ++k)
            worker.integrators[k] = std::make_unique<VisibilityIntegrator>(m_scene.occluder(), k ? probe : pattern,
                                                                           params[k], units, ground);
        worker.reconstruction = std::make_unique<Reconstruction>(m_params, pattern_error);
    }
    struct Sums
    {
        double squares = 0, plain = 0, fourth = 0, expected = 0, texels = 0;
    };
    std::vector<Sums> sums((m_windows.size() + most - 1) / most);
    // As many windows as fit are reconstructed as if they were one tile: no texel reaches into the next window.
    const auto work = [&](int64_t group, int index) {
        auto& [integrators, reconstruction] = workers[size_t(index)];
        constexpr int kHalo = NeighbourWindow::kHalo, kChannels = 5;
        constexpr size_t kPitch = size_t(kTileSize) * kChannels;
        std::vector<float> raw(kPitch * kTileSize);
        TexelContexts contexts(0, 0, kTileSize, kTileSize);
        reconstruction->clear();
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
                const Visibility seen = integrators[0]->integrate(
                    texel.point, pattern.texel(texel.x, texel.y, uint32_t(params[0].seed)), texel.open);
                const TexelContext context { texel.point.near_origin, texel.point.normal, texel.spacing,
                                             float(seen.error * seen.error) };
                const std::array<float, kChannels> channels { float(seen.visibility), float(seen.direction.x),
                                                              float(seen.direction.y), float(seen.direction.z), 0 };
                const Imath::V2i at = slot(k, i);
                reconstruction->add(at.x, at.y, channels.data(), context);
                if (at.x < 0 || at.y < 0 || at.x >= kTileSize || at.y >= kTileSize)
                    continue;
                contexts.at(at.x, at.y) = context;
                std::copy(channels.begin(), channels.end(),
                          raw.begin() + int64_t(size_t(at.y) * kPitch + size_t(at.x) * kChannels));
            }
        std::vector<float> texels = raw;
        reconstruction->apply(raw.data(), texels.data(), kPitch, 0, 0, contexts);
        Sums& sum = sums[size_t(group)];
        for (size_t k = first; k < last; ++k) {
            const Texel& texel = m_windows[k].texels[kMiddle];
            if (texel.spacing == 0)
                continue;
            const Imath::V2i at = slot(k, kMiddle);
            const size_t channel = size_t(at.y) * kPitch + size_t(at.x) * kChannels;
            double square = 1, plain_square = 1;
            for (size_t p = 1; p < 3; ++p) {
                const Point32 hash = texel_hash(uint32_t(texel.x), uint32_t(texel.y), uint32_t(params[p].seed));
                const double truth = integrators[p]->integrate(texel.point, hash, texel.open).visibility;
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
