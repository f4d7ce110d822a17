// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/tiles.h>

#include <vmlight/base/work_counts.h>
#include <vmlight/uv/margin.h>
#include <vmlight/vismap/bake_hints.h>

#include <algorithm>
#include <atomic>

namespace vmlight {
namespace {

// A margin up to this needs two tiles on each side; beyond it the whole map is baked.
constexpr int kFarthestMargin = 2 * kTileSize;

// What was done to a tile.
enum class Step
{
    baked,
    reconstructed,
    filled
};

// Map, tile, and the last step.
using TileKey = std::tuple<uint64_t, int, Step>;

// Never destroyed: threads of the host may still read while the process exits.
OnceCache<TileKey, MapTile>& cache()
{
    static auto& tiles = *new OnceCache<TileKey, MapTile>(size_t(512) << 20);
    return tiles;
}

uint64_t next_id()
{
    static std::atomic<uint64_t> count { 0 };
    return ++count;
}

OIIO::ROI tile_roi(const VismapBaker& baker, int tile)
{
    const int x = tile % baker.tiles_across() * kTileSize, y = tile / baker.tiles_across() * kTileSize;
    return { x, std::min(x + kTileSize, baker.width()), y, std::min(y + kTileSize, baker.height()) };
}

} // namespace

// A tile and the surroundings that its margin depends on: a margin texel is made of covered ones at most one margin
// width away, through filled ones that are nearer.
struct VismapTiles::Window
{
    Window(OIIO::ROI the_roi, int the_channels)
        : roi(the_roi)
        , channels(the_channels)
        , texels(size_t(roi.width()) * roi.height() * channels)
        , covered(roi.width(), roi.height())
    {
    }
    float* at(int x, int y)
    {
        return &texels[(size_t(y - roi.ybegin) * roi.width() + size_t(x - roi.xbegin)) * channels];
    }
    OIIO::ROI roi;
    int channels;
    std::vector<float> texels;
    Coverage covered;
};

VismapTiles::VismapTiles(const VismapBaker& baker, int margin)
    : m_baker(baker)
    , m_margin(margin)
    , m_whole(margin < 0 || margin > kFarthestMargin)
    , m_id(next_id())
{
}

VismapTiles::~VismapTiles()
{
    cache().erase({ m_id, 0, Step::baked }, { m_id + 1, 0, Step::baked });
}

void VismapTiles::set_cache_limit(size_t bytes)
{
    cache().set_limit(bytes);
}

MapTilePointer VismapTiles::tile(int tile)
{
    if (m_margin == 0)
        return reconstructed(tile);
    return cache().get({ m_id, tile, Step::filled }, [&] { return m_whole ? copied(tile) : filled(tile); });
}

MapTilePointer VismapTiles::baked(int tile)
{
    return cache().get({ m_id, tile, Step::baked }, [&] {
        auto result = std::make_shared<MapTile>();
        const auto scratch = m_baker.scratch();
        m_baker.cover_tile(tile, *scratch, result->covered);
        if (result->covered == TileBits {})
            return result;
        const size_t pitch = size_t(kTileSize) * m_baker.channels();
        result->texels.resize(pitch * kTileSize);
        BakeHints hints;
        if (is_reconstructed(m_baker.params())) {
            const OIIO::ROI own = tile_roi(m_baker, tile);
            result->contexts = TexelContexts(own.xbegin, own.ybegin, own.width(), own.height());
            hints.contexts = &result->contexts;
        }
        m_baker.bake_tile(tile, *scratch, result->texels.data(), pitch, result->covered, &hints);
        ++work_counts().tiles_baked;
        return result;
    });
}

// Those of the eight tiles around are baked that have a covered texel within reach, and those that have one beyond a
// seam.
MapTilePointer VismapTiles::reconstructed(int tile)
{
    if (!is_reconstructed(m_baker.params()))
        return baked(tile);
    return cache().get({ m_id, tile, Step::reconstructed }, [&] {
        const MapTilePointer raw = baked(tile);
        auto result = std::make_shared<MapTile>();
        result->texels = raw->texels;
        result->covered = raw->covered;
        if (raw->texels.empty())
            return result;
        Reconstruction reconstruction(m_baker.params(), m_baker.error().pattern_error, m_baker.error().error_scale);
        BakedTiles tiles(m_baker, [&](int other) { return baked(other); });
        reconstruct_tile(
            reconstruction, m_baker, tile, [&](int x, int y) { return tiles.at(x, y); }, raw->texels.data(),
            result->texels.data(), size_t(kTileSize) * m_baker.channels(), raw->contexts);
        return result;
    });
}

// Add a tile to the window; baked only if the window has one of its covered texels. Returns whether it does.
bool VismapTiles::add_tile(Window& window, int tile, VismapBaker::Scratch& scratch)
{
    TileBits bits;
    m_baker.cover_tile(tile, scratch, bits);
    const OIIO::ROI own = tile_roi(m_baker, tile), both = OIIO::roi_intersection(own, window.roi);
    bool any = false;
    for (int y = both.ybegin; y < both.yend; ++y)
        for (int x = both.xbegin; x < both.xend; ++x)
            if (bits[size_t(y - own.ybegin)] >> (x - own.xbegin) & 1) {
                window.covered.set(x - window.roi.xbegin, y - window.roi.ybegin);
                any = true;
            }
    if (!any)
        return false;
    const MapTilePointer raw = reconstructed(tile);
    const size_t row = size_t(both.width()) * m_baker.channels();
    for (int y = both.ybegin; y < both.yend; ++y) {
        const size_t first = size_t(y - own.ybegin) * kTileSize + size_t(both.xbegin - own.xbegin);
        std::copy_n(&raw->texels[first * m_baker.channels()], row, window.at(both.xbegin, y));
    }
    return true;
}

MapTilePointer VismapTiles::filled(int tile)
{
    const OIIO::ROI own = tile_roi(m_baker, tile);
    const auto scratch = m_baker.scratch();
    auto result = std::make_shared<MapTile>();
    m_baker.cover_tile(tile, *scratch, result->covered);
    const uint64_t full = ~uint64_t(0) >> (kTileSize - own.width());
    if (std::all_of(result->covered.begin(), result->covered.begin() + own.height(),
                    [&](uint64_t row) { return row == full; }))
        return reconstructed(tile);

    Window window({ std::max(0, own.xbegin - m_margin), std::min(m_baker.width(), own.xend + m_margin),
                    std::max(0, own.ybegin - m_margin), std::min(m_baker.height(), own.yend + m_margin) },
                  m_baker.channels());
    bool any = false;
    for (int y = window.roi.ybegin / kTileSize; y <= (window.roi.yend - 1) / kTileSize; ++y)
        for (int x = window.roi.xbegin / kTileSize; x <= (window.roi.xend - 1) / kTileSize; ++x)
            any |= add_tile(window, y * m_baker.tiles_across() + x, *scratch);
    if (!any)
        return result;
    fill_margin(window.texels.data(), window.channels, window.covered, m_margin, m_baker.margin_channels());
    const size_t pitch = size_t(kTileSize) * window.channels;
    result->texels.resize(pitch * kTileSize);
    for (int y = own.ybegin; y < own.yend; ++y)
        std::copy_n(window.at(own.xbegin, y), size_t(own.width()) * window.channels,
                    &result->texels[size_t(y - own.ybegin) * pitch]);
    return result;
}

MapTilePointer VismapTiles::copied(int tile)
{
    std::string error;
    m_bake_map.run(
        [&](std::string&) {
            std::vector<float> map(size_t(m_baker.width()) * m_baker.height() * m_baker.channels());
            Coverage covered(m_baker.width(), m_baker.height());
            BakeCounts counts;
            TexelContexts contexts;
            BakeHints hints;
            if (is_reconstructed(m_baker.params())) {
                contexts = TexelContexts(0, 0, m_baker.width(), m_baker.height());
                hints.contexts = &contexts;
            }
            m_baker.bake_all(map.data(), covered, counts, 0, {}, &hints);
            if (hints.contexts)
                reconstruct_map(m_baker, map.data(), contexts, counts.dark, 0, {});
            fill_margin(map.data(), m_baker.channels(), covered, m_margin, m_baker.margin_channels());
            work_counts().tiles_baked += counts.tiles;
            m_map.swap(map);
            return true;
        },
        error);
    const OIIO::ROI own = tile_roi(m_baker, tile);
    const size_t channels = size_t(m_baker.channels());
    auto result = std::make_shared<MapTile>();
    result->texels.resize(kTileSize * kTileSize * channels);
    for (int y = own.ybegin; y < own.yend; ++y)
        std::copy_n(&m_map[(size_t(y) * m_baker.width() + own.xbegin) * channels], own.width() * channels,
                    &result->texels[size_t(y - own.ybegin) * kTileSize * channels]);
    return result;
}

void VismapTiles::read(OIIO::ROI roi, float* dst)
{
    const size_t channels = size_t(m_baker.channels());
    std::fill_n(dst, size_t(roi.width()) * roi.height() * channels, 0.0f);
    for (int ty = roi.ybegin / kTileSize; ty <= (roi.yend - 1) / kTileSize; ++ty)
        for (int tx = roi.xbegin / kTileSize; tx <= (roi.xend - 1) / kTileSize; ++tx) {
            const int index = ty * m_baker.tiles_across() + tx;
            const MapTilePointer source = tile(index);
            const OIIO::ROI own = tile_roi(m_baker, index), both = OIIO::roi_intersection(own, roi);
            for (int y = both.ybegin; y < both.yend && !source->texels.empty(); ++y) {
                const size_t from = size_t(y - own.ybegin) * kTileSize + size_t(both.xbegin - own.xbegin);
                const size_t to = size_t(y - roi.ybegin) * roi.width() + size_t(both.xbegin - roi.xbegin);
                std::copy_n(&source->texels[from * channels], both.width() * channels, dst + to * channels);
            }
        }
}

} // namespace vmlight
