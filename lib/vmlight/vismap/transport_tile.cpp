// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/transport_tile.h>

#include <vmlight/vismap/bounce_rays.h>

#include <algorithm>
#include <utility>

namespace vmlight {

void TracedTile::count(TransportTile& dst, const std::vector<uint32_t>& numbers, uint32_t patches)
{
    dst.receivers = receivers;
    dst.entries.clear();
    auto hit = met.begin();
    for (TransportTile::Receiver& receiver : dst.receivers) {
        const auto end = hit + receiver.entries;
        for (auto number = hit; number != end; ++number)
            if (*number & BounceRays::kCell)
                *number = patches + numbers[*number & ~BounceRays::kCell];
        std::sort(hit, end);
        const size_t before = dst.entries.size();
        for (; hit != end; ++hit) {
            uint32_t* last = dst.entries.size() > before ? &dst.entries.back() : nullptr;
            if (last && TransportTile::number_of(*last) == *hit
                && TransportTile::count_of(*last) < TransportTile::kMostCount)
                ++*last;
            else
                dst.entries.push_back(*hit << TransportTile::kCountBits | 1);
        }
        receiver.entries = uint16_t(dst.entries.size() - before);
    }
}

std::vector<CellOrder::Numbered> CellOrder::add(int64_t tile, TracedTile traced)
{
    const std::lock_guard<std::mutex> lock(m_mutex);
    m_waiting_bytes += traced.bytes();
    m_waiting.emplace(tile, std::move(traced));
    std::vector<Numbered> ready;
    for (auto first = m_waiting.begin(); first != m_waiting.end() && first->first == m_next; ++m_next) {
        Numbered& own = ready.emplace_back(Numbered { m_next, std::move(first->second), {} });
        m_waiting_bytes -= own.traced.bytes();
        m_cells.merge(own.traced.cells, own.numbers);
        own.traced.cells = {};
        first = m_waiting.erase(first);
    }
    // The points are copied in the end.
    m_bytes = m_waiting_bytes + m_cells.bytes() + m_cells.count() * (sizeof(LightPoint) + sizeof(SurfacePoint));
    m_count = m_cells.count();
    return ready;
}

} // namespace vmlight
