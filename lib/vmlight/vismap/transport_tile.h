// SPDX-License-Identifier: Apache-2.0
/// What the rays of a tile meet, as LightTransport keeps it.
#pragma once

#include <vmlight/vismap/light_cells.h>

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <vector>

namespace vmlight {

/// Kept of a tile: for each texel that something blocks the view of, what its rays meet, and how often.
struct TransportTile
{
    // Of an entry: the number of what is met, and how often.
    static constexpr int kCountBits = 8;
    static constexpr uint32_t kMostNumbers = 1u << (32 - kCountBits), kMostCount = (1u << kCountBits) - 1;
    static uint32_t number_of(uint32_t entry) { return entry >> kCountBits; }
    static uint32_t count_of(uint32_t entry) { return entry & kMostCount; }

    struct Receiver
    {
        uint16_t texel; // in the tile
        uint16_t entries; // after those of the receivers before
        float scale; // of a ray
    };
    std::vector<Receiver> receivers;
    std::vector<uint32_t> entries; // numbers of patches and then cells, and counts

    size_t bytes() const { return receivers.capacity() * sizeof(Receiver) + entries.capacity() * sizeof(uint32_t); }
};

/// The same as it is traced, one hit after the other: patches, and cells by their numbers in `cells`.
struct TracedTile
{
    std::vector<TransportTile::Receiver> receivers;
    std::vector<uint32_t> met;
    LightCells cells;

    size_t bytes() const
    {
        return receivers.capacity() * sizeof(TransportTile::Receiver) + met.capacity() * sizeof(uint32_t)
            + cells.bytes();
    }
    /// Sort and count what is met; `numbers` are those of its cells among all, which come after `patches` patches.
    /// Leaves `met` in disorder.
    void count(TransportTile& dst, const std::vector<uint32_t>& numbers, uint32_t patches);
};

/// Numbers the cells of tiles in the order of the tiles, whichever is traced first.
class CellOrder
{
public:
    explicit CellOrder(LightCells& cells)
        : m_cells(cells)
    {
    }

    struct Numbered
    {
        int64_t tile;
        TracedTile traced;
        std::vector<uint32_t> numbers; // of its cells
    };
    /// Take a tile; returns those whose cells can be numbered now. Any thread.
    std::vector<Numbered> add(int64_t tile, TracedTile traced);
    size_t bytes() const { return m_bytes; }
    size_t count() const { return m_count; }

private:
    std::mutex m_mutex;
    LightCells& m_cells;
    std::map<int64_t, TracedTile> m_waiting;
    int64_t m_next = 0;
    size_t m_waiting_bytes = 0;
    std::atomic<size_t> m_bytes { 0 }, m_count { 0 };
};

} // namespace vmlight
