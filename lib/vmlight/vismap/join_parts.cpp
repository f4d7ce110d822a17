// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/join_parts.h>

#include <vmlight/base/available_memory.h>
#include <vmlight/base/format.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/image/channels.h>
#include <vmlight/uv/margin.h>
#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/map_part.h>

#include <algorithm>
#include <optional>
#include <vector>

namespace vmlight {
namespace {

// A map that parts are put into.
class JoinedMap
{
public:
    bool begin(OIIO::ImageBuf& dst, const OIIO::ImageSpec& part, std::string& error)
    {
        const OIIO::ImageSpec spec = whole_of_part(part);
        error = memory_shortage(spec);
        if (!error.empty())
            return false;
        m_first = part;
        dst.reset(spec, OIIO::InitializePixels::Yes);
        m_pixels = static_cast<float*>(dst.localpixels());
        if (!m_pixels) {
            error = format("out of memory for {}x{} texels", spec.width, spec.height);
            return false;
        }
        m_names = spec.channelnames;
        m_covered.emplace(spec.width, spec.height);
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
        for (int tile = tiles.first; tile < tiles.end; ++tile)
            put(part, tile_window(part.spec(), tile), channels, coverage);
        m_next = std::max(m_next, tiles.end);
        return true;
    }

    bool finish(JoinReport& report, std::string& error)
    {
        if (const int all = tile_count(m_first); m_next != all) {
            error = format("the parts have {} of {} tiles", m_next, all);
            return false;
        }
        VismapParams params;
        if (!set_param(params, "margin", m_first.get_string_attribute("vmlight:margin"), error))
            return false;
        const Stopwatch timer;
        fill_margin(m_pixels, int(m_names.size()), *m_covered, params.margin, margin_channels_of(m_names));
        m_report.margin_seconds = timer();
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
        const OIIO::ImageSpec& spec = part.spec();
        const float* const pixels = static_cast<const float*>(part.localpixels());
        for (int y = window.ybegin; y < window.yend; ++y)
            for (int x = window.xbegin; x < window.xend; ++x) {
                const float* const from
                    = pixels + (size_t(y - spec.y) * size_t(spec.width) + size_t(x - spec.x)) * size_t(spec.nchannels);
                if (from[coverage] == 0)
                    continue;
                float* const to = m_pixels + (size_t(y) * size_t(m_covered->width()) + size_t(x)) * m_names.size();
                for (size_t c = 0; c < channels.size(); ++c)
                    to[c] = from[channels[c]];
                m_covered->set(x, y);
                ++m_report.covered;
                m_report.dark += to[0] < 0.01f;
            }
    }

    OIIO::ImageSpec m_first; // of the first part
    std::vector<std::string> m_names;
    float* m_pixels = nullptr;
    std::optional<Coverage> m_covered;
    int m_next = 0; // tile
    JoinReport m_report;
};

// The parts one by one, in their order.
bool put_parts(JoinedMap& map, OIIO::ImageBuf& dst, int count, const ReadPart& read, std::string& error)
{
    for (int index = 1; index <= count; ++index) {
        OIIO::ImageBuf part;
        PartNumber number;
        TileRange tiles;
        if (!read(part, index, error) || !read_part(number, tiles, part.spec(), error)
            || (index == 1 && !map.begin(dst, part.spec(), error)))
            return false;
        if (number.index != index || number.count != count) {
            error = format("it is part {}, not {}", part_text(number), part_text({ index, count }));
            return false;
        }
        if (!map.add(part, tiles, error))
            return false;
    }
    return true;
}

} // namespace

bool join_parts(OIIO::ImageBuf& dst, int count, const ReadPart& read, JoinReport& report, std::string& error)
{
    JoinedMap map;
    if (put_parts(map, dst, count, read, error) && map.finish(report, error))
        return true;
    dst.clear();
    return false;
}

} // namespace vmlight
