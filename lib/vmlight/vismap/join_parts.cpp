// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/join_parts.h>

#include <vmlight/base/available_memory.h>
#include <vmlight/base/format.h>
#include <vmlight/base/tile_size.h>
#include <vmlight/image/channels.h>
#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/map_part.h>
#include <vmlight/vismap/margin_rows.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace vmlight {
namespace {

// Rows of tiles that are given away at once.
constexpr int kBand = 4;

// A map that parts are put into, and that is given away as its rows are whole.
class JoinedMap
{
public:
    explicit JoinedMap(const MapRows& rows)
        : m_rows(rows)
    {
    }

    bool begin(const OIIO::ImageSpec& part, std::string& error)
    {
        OIIO::ImageSpec spec = whole_of_part(part);
        VismapParams params;
        if (!set_param(params, "margin", part.get_string_attribute("vmlight:margin"), error))
            return false;
        m_first = part;
        m_names = spec.channelnames;
        m_width = spec.width;
        m_height = spec.height;
        error = memory_shortage(part, // nothing is more than a part and these
                                MarginRows::held_bytes(m_width, m_height, spec.nchannels, params.margin, kBand));
        if (!error.empty() || !m_rows.begin(spec, error))
            return false;
        m_margin.emplace(m_width, m_height, spec.nchannels, params.margin, margin_channels_of(m_names), kBand);
        return true;
    }

    // Parts come in their order: their tiles follow each other.
    bool add(const OIIO::ImageBuf& part, TileRange tiles, std::string& error)
    {
        error = part_fault(part.spec(), m_first);
        if (!error.empty())
            return false;
        if (tiles.count() > 0 && tiles.first != m_next) {
            error = format("its tiles begin with {}, not {}: it is of a map that was divided differently", tiles.first,
                           m_next);
            return false;
        }
        std::vector<size_t> channels;
        for (const std::string& name : m_names)
            channels.push_back(channel_of(part.spec(), name));
        const size_t coverage = channel_of(part.spec(), kCoverageChannel);
        for (int tile = tiles.first; tile < tiles.end; ++tile) {
            put(part, tile_window(part.spec(), tile), channels, coverage);
            m_next = tile + 1;
            if (m_next % tiles_across() == 0 && !give_row(error))
                return false;
        }
        return true;
    }

    bool finish(JoinReport& report, std::string& error)
    {
        if (const int all = tile_count(m_first); m_next != all) {
            error = format("the parts have {} of {} tiles", m_next, all);
            return false;
        }
        m_report.margin_seconds = m_margin->seconds();
        report = m_report;
        return true;
    }

private:
    static size_t channel_of(const OIIO::ImageSpec& spec, const std::string& name)
    {
        const auto found = std::find(spec.channelnames.begin(), spec.channelnames.end(), name);
        return size_t(found - spec.channelnames.begin());
    }

    void put(const OIIO::ImageBuf& part, OIIO::ROI window, const std::vector<size_t>& channels, size_t coverage)
    {
        if (!m_row) {
            const int rows = std::min(kTileSize, m_height - window.ybegin);
            m_row
                = { std::vector<float>(size_t(m_width) * size_t(rows) * m_names.size()), Coverage(m_width, rows), {} };
        }
        const OIIO::ImageSpec& spec = part.spec();
        const float* const pixels = static_cast<const float*>(part.localpixels());
        for (int y = window.ybegin; y < window.yend; ++y)
            for (int x = window.xbegin; x < window.xend; ++x) {
                const float* const from
                    = pixels + (size_t(y - spec.y) * size_t(spec.width) + size_t(x - spec.x)) * size_t(spec.nchannels);
                if (from[coverage] == 0)
                    continue;
                float* const to
                    = &m_row->texels[(size_t(y % kTileSize) * size_t(m_width) + size_t(x)) * m_names.size()];
                for (size_t c = 0; c < channels.size(); ++c)
                    to[c] = from[channels[c]];
                m_row->covered.set(x, y % kTileSize);
                ++m_report.covered;
                m_report.dark += to[0] < 0.01f;
            }
    }

    int tiles_across() const { return (m_width + kTileSize - 1) / kTileSize; }

    bool give_row(std::string& error)
    {
        TileRow row = std::move(*m_row);
        m_row.reset();
        return m_margin->add(std::move(row), [&](int ybegin, int yend, const float* texels) {
            return m_rows.take(ybegin, yend, texels, error);
        });
    }

    const MapRows& m_rows;
    OIIO::ImageSpec m_first; // of the first part
    std::vector<std::string> m_names;
    int m_width = 0, m_height = 0;
    std::optional<MarginRows> m_margin;
    std::optional<TileRow> m_row; // that is not whole yet
    int m_next = 0; // tile
    JoinReport m_report;
};

} // namespace

bool join_parts(const MapRows& rows, int count, const ReadPart& read, JoinReport& report, std::string& error)
{
    JoinedMap map(rows);
    for (int index = 1; index <= count; ++index) {
        OIIO::ImageBuf part;
        PartNumber number;
        TileRange tiles;
        if (!read(part, index, error) || !read_part(number, tiles, part.spec(), error)
            || (index == 1 && !map.begin(part.spec(), error)))
            return false;
        if (number.index != index || number.count != count) {
            error = format("it is part {}, not {}", part_text(number), part_text({ index, count }));
            return false;
        }
        if (!map.add(part, tiles, error))
            return false;
    }
    return map.finish(report, error);
}

} // namespace vmlight
