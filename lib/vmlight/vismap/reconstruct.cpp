// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/reconstruct.h>

#include <vmlight/base/available_memory.h>
#include <vmlight/image/channels.h>
#include <vmlight/math/harmonics.h>
#include <vmlight/math/longest_direction.h>
#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/basis.h>
#include <vmlight/vismap/neighbour_means.h>
#include <vmlight/vismap/sun_visibility.h>
#include <vmlight/vismap/visibility_integrator.h>

#include <algorithm>
#include <cmath>

namespace vmlight {

using Imath::V3d;
using Imath::V3f;

namespace {

// Of the length of a float vector.
constexpr double kLengthRounding = 1e-6;

// How far the neighbours may move V and B' of a texel, squared, in the variance of both. Beyond that its own rays say
// that it is unlike them. Measured on ten scenes: below 4 the RMS error gains less, from 6 on the worst texels of
// creases grow.
constexpr float kFarthestChange = 4;

// The share of a change that is kept. A few rays may all agree by chance: the scatter around the texel counts, too.
float limit_change(const NeighbourWindow& window, size_t at, const std::array<float, 4>& change)
{
    constexpr int kPatch = NeighbourWindow::kPatch;
    float scatter = 0, covered = 0, squared = 0;
    for (int y = -kPatch; y <= kPatch; ++y)
        for (int x = -kPatch; x <= kPatch; ++x) {
            const size_t near = size_t(int64_t(at) + y * NeighbourWindow::kStride + x);
            scatter += window.variance[near];
            covered += window.spacing[near] > 0 ? 1.0f : 0.0f;
        }
    for (const float part : change)
        squared += part * part;
    const float farthest
        = kFarthestChange * kVarianceOfBoth * std::max(window.variance[at], scatter / std::max(covered, 1.0f));
    return squared > farthest ? std::sqrt(farthest / squared) : 1;
}

} // namespace

std::string reconstruct_fault(const VismapParams& params)
{
    if (params.reconstruct == "off")
        return "reconstruct is off";
    if (params.measure != "cosine")
        return "with the measure uniform, B is not a mean over rays";
    if (find_basis(params.basis).whole_numbers)
        return "what the basis " + params.basis + " packs of each ray has no mean";
    if (params.samples < 2 && params.target_error <= 0)
        return "it needs at least 2 rays per texel";
    return "";
}

double reconstruct_bytes(const VismapParams& params)
{
    const double texels = double(params.size().width) * params.size().height;
    return is_reconstructed(params)
        ? texels * double(size_t(describe_vismap("", params).nchannels) * sizeof(float) + sizeof(TexelContext))
        : 0;
}

std::string map_memory_shortage(const OIIO::ImageSpec& spec, const VismapParams& params)
{
    const double more = reconstruct_bytes(params);
    const std::string shortage = memory_shortage(spec, more);
    return shortage.empty() || more == 0 || !memory_shortage(spec).empty()
        ? shortage
        : shortage + "; with --reconstruct off it fits";
}

Reconstruction::Reconstruction(const VismapParams& params, double pattern_error, double error_scale)
    : m_layout { size_t(describe_vismap("", params).nchannels), kVismapChannels.size() + (params.has("normal") ? 3 : 0),
                 kVismapChannels.size() + (params.has("normal") ? 3 : 0) + (params.has("error") ? 1 : 0)
                     + sun_channels(params.sun_directions).size(),
                 params.basis == "sh" ? params.order : 0, params.has("error") }
    , m_pattern_error(pattern_error)
    , m_error_scale(float(error_scale))
{
    if (m_layout.order > 0)
        m_harmonics = std::make_unique<Harmonics>(m_layout.order);
    m_bands.assign(m_layout.order > 0 ? size_t(m_layout.order * m_layout.order) - 4 : 0,
                   NeighbourWindow::Plane(m_window.spacing.size()));
    m_open = m_bands;
    m_planes = { &m_window.variance, &m_window.spacing };
    for (NeighbourWindow::Plane& plane : m_window.values)
        m_planes.push_back(&plane);
    for (size_t c = 0; c < 3; ++c)
        m_planes.insert(m_planes.end(), { &m_window.normal[c], &m_window.position[c] });
    for (size_t k = 0; k < m_bands.size(); ++k)
        m_planes.insert(m_planes.end(), { &m_bands[k], &m_open[k] });
    m_values.resize(size_t(m_layout.order * m_layout.order) * Harmonics::kLanes);
    for (std::vector<float>& change : m_change)
        change.resize(size_t(kTileSize) * kTileSize);
    m_narrowed = m_kept = m_band_change = m_change[0];
}

Reconstruction::~Reconstruction() = default;

void Reconstruction::add(int x, int y, const float* texel, const TexelContext& context)
{
    const size_t i = NeighbourWindow::index(x, y);
    const float open = 2.0f / 3 * texel[0];
    m_window.values[0][i] = texel[0];
    m_window.variance[i] = float(pattern_variance(double(context.variance), m_pattern_error));
    for (int c = 0; c < 3; ++c) {
        m_window.values[size_t(c) + 1][i] = texel[c + 1] - open * context.normal[c];
        m_window.normal[size_t(c)][i] = context.normal[c];
        m_window.position[size_t(c)][i] = context.position[c];
    }
    m_window.spacing[i] = context.spacing;
    if (m_bands.empty())
        return;
    std::array<float, Harmonics::kLanes> nx, ny, nz;
    nx.fill(context.normal.x), ny.fill(context.normal.y), nz.fill(context.normal.z);
    m_harmonics->evaluate(nx.data(), ny.data(), nz.data(), m_values.data());
    for (int l = 2; l < m_layout.order; ++l)
        for (int k = l * l; k < (l + 1) * (l + 1); ++k) {
            const float lobe = float(cosine_eigenvalue(l)) * m_values[size_t(k) * Harmonics::kLanes];
            m_open[size_t(k - 4)][i] = lobe;
            m_bands[size_t(k - 4)][i] = texel[m_layout.bands_at + size_t(k - 4)] - lobe * texel[0];
        }
}

int64_t Reconstruction::apply(const float* raw, float* texels, size_t pitch, int left, int top,
                              const TexelContexts& contexts, const std::vector<Continuation>& continuations)
{
    std::vector<uint32_t> islands(m_change[0].size(), kNoIsland);
    for (size_t i = 0; i < islands.size(); ++i) {
        const int x = int(i % kTileSize), y = int(i / kTileSize);
        if (m_window.spacing[NeighbourWindow::index(x, y)] > 0)
            islands[i] = contexts.at(left + x, top + y).island;
    }
    std::vector<float> added;
    for (const IslandLayer& layer : layers_of_islands(islands, continuations)) {
        if (layer.texels == decltype(layer.texels) {})
            continue;
        added.clear();
        const auto each = [&](auto&& visit) {
            for (const auto& [first, last] : layer.continuations)
                for (size_t k = first; k < last; ++k)
                    visit(continuations[k], NeighbourWindow::index(continuations[k].x, continuations[k].y));
        };
        each([&](const Continuation& there, size_t i) {
            for (const NeighbourWindow::Plane* plane : m_planes)
                added.push_back((*plane)[i]);
            add(there.x, there.y, there.texel, *there.context);
        });
        want_scattered(layer.texels);
        if (m_window.wanted != decltype(m_window.wanted) {})
            apply_layer(raw, texels, pitch, left, top, contexts);
        const float* value = added.data();
        each([&](const Continuation&, size_t i) {
            for (NeighbourWindow::Plane* plane : m_planes)
                (*plane)[i] = *value++;
        });
    }
    int64_t dark = 0;
    for (size_t i = 0; i < islands.size(); ++i)
        dark += m_window.spacing[NeighbourWindow::index(int(i % kTileSize), int(i / kTileSize))] > 0
            && texels[i / kTileSize * pitch + i % kTileSize * m_layout.channels] < 0.01f;
    return dark;
}

// A texel that keeps what it has gives nothing either: where few rays are blocked, others would lose to it what it does
// not take from them, and less would be hidden than rays have met.
void Reconstruction::want_scattered(const std::array<uint64_t, kTileSize>& texels)
{
    constexpr int kPatch = NeighbourWindow::kPatch, kReach = NeighbourWindow::kReach;
    for (int row = -kReach; row < kTileSize + kReach; ++row)
        for (int x = -kReach; x < kTileSize + kReach; ++x) {
            bool scatters = false;
            for (int y = row - kPatch; y <= row + kPatch; ++y)
                for (int column = x - kPatch; column <= x + kPatch; ++column)
                    scatters |= m_window.variance[NeighbourWindow::index(column, y)] > 0;
            m_window.gives[NeighbourWindow::index(x, row)] = scatters ? 1.0f : 0.0f;
        }
    for (int row = 0; row < kTileSize; ++row) {
        uint64_t& wanted = m_window.wanted[size_t(row)];
        wanted = texels[size_t(row)];
        for (int x = 0; x < kTileSize; ++x)
            if (!(m_window.gives[NeighbourWindow::index(x, row)] > 0))
                wanted &= ~(uint64_t(1) << x);
    }
}

void Reconstruction::apply_layer(const float* raw, float* texels, size_t pitch, int left, int top,
                                 const TexelContexts& contexts)
{
    weigh_neighbours(m_window);
    for (size_t c = 0; c < 4; ++c)
        mean_change(m_window, m_window.values[c].data(), m_change[c].data());
    std::vector<float> variance(m_layout.has_error ? m_change[0].size() : 0);
    if (m_layout.has_error)
        mean_variance(m_window, variance.data());
    std::vector<size_t> changed;
    for (size_t i = 0; i < m_change[0].size(); ++i) {
        const int x = int(i % kTileSize), y = int(i / kTileSize);
        if (!(m_window.wanted[size_t(y)] >> x & 1))
            continue;
        const size_t at = size_t(y) * pitch + size_t(x) * m_layout.channels;
        const TexelContext& context = contexts.at(left + x, top + y);
        std::array<float, 4> change { m_change[0][i], m_change[1][i], m_change[2][i], m_change[3][i] };
        const size_t window = NeighbourWindow::index(x, y);
        const float kept = m_kept[i] = limit_change(m_window, window, change);
        for (float& part : change)
            part *= kept;
        if (m_layout.has_error)
            texels[at + m_layout.error_at]
                = m_error_scale * (kept * std::sqrt(variance[i]) + (1 - kept) * std::sqrt(m_window.variance[window]));
        if (change != std::array<float, 4> {} || !m_bands.empty()) {
            const double visibility = std::clamp(double(raw[at]) + double(change[0]), 0.0, 1.0);
            V3d direction = V3d(raw[at + 1], raw[at + 2], raw[at + 3]) + V3d(change[1], change[2], change[3])
                + V3d(context.normal) * (2.0 / 3 * double(change[0]));
            const double length = direction.length(), longest = longest_direction(visibility);
            m_narrowed[i] = 1;
            if (length > std::min(visibility, longest * (1 + kLengthRounding))) {
                m_narrowed[i] = float(longest / length);
                direction *= longest / length;
            }
            if (change != std::array<float, 4> {}) {
                texels[at] = float(visibility);
                for (int c = 0; c < 3; ++c)
                    texels[at + 1 + size_t(c)] = float(direction[c]);
            }
            changed.push_back(i);
        }
    }
    if (!m_bands.empty())
        change_bands(raw, texels, pitch, changed);
}

void Reconstruction::change_bands(const float* raw, float* texels, size_t pitch, const std::vector<size_t>& changed)
{
    for (int l = 2; l < m_layout.order; ++l)
        for (int k = l * l; k < (l + 1) * (l + 1); ++k) {
            mean_change(m_window, m_bands[size_t(k - 4)].data(), m_band_change.data());
            for (const size_t i : changed) {
                const int x = int(i % kTileSize), y = int(i / kTileSize);
                const size_t window = NeighbourWindow::index(x, y);
                const size_t at = size_t(y) * pitch + size_t(x) * m_layout.channels;
                const float change = m_band_change[i] + m_open[size_t(k - 4)][window] * m_change[0][i];
                const float sum = raw[at + m_layout.bands_at + size_t(k - 4)] + m_kept[i] * change;
                texels[at + m_layout.bands_at + size_t(k - 4)]
                    = m_narrowed[i] == 1 ? sum : sum * float(std::pow(double(m_narrowed[i]), 0.5 * l * (l + 1)));
            }
        }
}

} // namespace vmlight
