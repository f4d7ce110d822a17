// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/transport_tile.h>

#include <vmlight/vismap/ground_of.h>

#include <algorithm>
#include <utility>

namespace vmlight {

TransportMap::TransportMap(BakeScenePointer scene, const VismapParams& map, NormalMapPointer normal_map, int rays,
                           bool the_ground_reflects)
    : points(std::move(scene), map, std::move(normal_map))
    , patches(points)
    , pattern("fibonacci", rays, false)
    , ground(ground_of(points.scene(), map))
    , ground_reflects(the_ground_reflects)
{
}

TransportTracer::TransportTracer(const TransportMap& map)
    : m_map(map)
    , m_rays(map.points, map.patches, map.pattern, map.ground, map.ground_reflects)
{
}

TracedTile& TransportTracer::trace(int tile)
{
    const MapPoints& map = m_map.points;
    const bool has_visibility = !m_map.visibility.empty(), is_cosine = map.params().measure == "cosine";
    std::vector<uint32_t>& met = m_traced.met;
    m_rays.cells().clear();
    m_traced.receivers.clear();
    met.clear();
    for (const MapPoint& point : map.of_tile(tile, m_scratch)) {
        const size_t texel = map.texel(tile, point), before = met.size();
        const double hidden = has_visibility ? std::min(1.0, 1 - double(m_map.visibility[texel])) : 1;
        if (!(hidden > 0))
            continue;
        const BounceRays::Count count
            = m_rays.trace(point.surface, texel, map.left(tile) + point.x, map.top(tile) + point.y, met);
        if (met.size() == before)
            continue;
        // What is blocked is known better from the map.
        const double scale = has_visibility && is_cosine ? hidden / count.blocked : 1.0 / count.all;
        m_traced.receivers.push_back(
            { uint16_t(point.y * kTileSize + point.x), uint16_t(met.size() - before), float(scale) });
    }
    std::swap(m_traced.cells, m_rays.cells());
    return m_traced;
}

void TransportTracer::count(TransportTile& dst, TracedTile& traced)
{
    const uint32_t patches = m_map.patches.count();
    m_map.cells.find(traced.cells, m_numbers);
    dst.receivers = traced.receivers;
    dst.entries.clear();
    auto met = traced.met.begin();
    for (TransportTile::Receiver& receiver : dst.receivers) {
        const auto end = met + receiver.entries;
        for (auto number = met; number != end; ++number)
            if (*number & BounceRays::kCell)
                *number = patches + m_numbers[*number & ~BounceRays::kCell];
        std::sort(met, end);
        const size_t before = dst.entries.size();
        for (; met != end; ++met) {
            if (dst.entries.size() > before && TransportTile::number_of(dst.entries.back()) == *met)
                ++dst.entries.back();
            else
                dst.entries.push_back(*met << TransportTile::kCountBits | 1);
        }
        receiver.entries = uint16_t(dst.entries.size() - before);
    }
}

} // namespace vmlight
