// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/map_patches.h>

#include <vmlight/base/parallel.h>
#include <vmlight/uv/islands.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vmlight {
namespace {

using Imath::V2d;
using Imath::V3f;

// Fine enough for what light does on the map: measured, docs/accuracy.md.
constexpr int kLargestBlock = 4;
constexpr double kLeastPatches = 1 << 14;

int block_of(int width, int height)
{
    int block = 1;
    while (block < kLargestBlock && double(width) * height / (4.0 * block * block) >= kLeastPatches)
        block *= 2;
    return block;
}

bool are_equal(const Mesh& a, const std::array<uint32_t, 3>& s, const Mesh& b, const std::array<uint32_t, 3>& t)
{
    for (size_t k = 0; k < 3; ++k)
        if (a.positions[s[k]] != b.positions[t[k]])
            return false;
    return true;
}

// A part has the triangles of the whole in their order. Of several equal ones it may be any.
std::vector<uint32_t> number_baked(const Mesh& whole, const Mesh& part)
{
    if (&whole == &part)
        return {};
    std::vector<uint32_t> numbers(whole.triangles.size(), MapPatches::kNone);
    uint32_t next = 0;
    for (size_t t = 0; t < numbers.size() && next < part.triangles.size(); ++t)
        if (are_equal(whole, whole.triangles[t], part, part.triangles[next]))
            numbers[t] = next++;
    return numbers;
}

} // namespace

MapPatches::MapPatches(const MapPoints& map)
    : m_map(map)
    , m_block(block_of(map.width(), map.height()))
    , m_baked_triangle(number_baked(map.scene().whole(), map.scene().mesh()))
    , m_island_of_triangle(islands_of_triangles(map.scene().mesh()))
    , m_patch_of_texel(size_t(map.width()) * size_t(map.height()), kNone)
    , m_tiles(size_t(map.tiles()))
{
}

void MapPatches::add(int tile, const std::vector<MapPoint>& points)
{
    std::vector<uint32_t>& islands = m_tiles[size_t(tile)].islands;
    const int across = kTileSize / m_block;
    // The patches of each block: few.
    std::vector<std::vector<uint32_t>> patches(size_t(across) * size_t(across));
    for (const MapPoint& point : points) {
        const uint32_t island = m_island_of_triangle[point.triangle];
        auto& candidates = patches[size_t(point.y / m_block * across + point.x / m_block)];
        const auto known = std::find_if(candidates.begin(), candidates.end(),
                                        [&](uint32_t patch) { return islands[patch] == island; });
        const uint32_t patch = known == candidates.end() ? uint32_t(islands.size()) : *known;
        if (known == candidates.end()) {
            candidates.push_back(patch);
            islands.push_back(island);
        }
        m_patch_of_texel[m_map.texel(tile, point)] = patch;
    }
}

void MapPatches::number()
{
    for (Tile& tile : m_tiles) {
        tile.first = uint32_t(m_islands.size());
        m_islands.insert(m_islands.end(), tile.islands.begin(), tile.islands.end());
        tile.islands = {};
    }
    const size_t width = size_t(m_map.width()), across = size_t(m_map.raster().tiles_across());
    for (size_t i = 0; i < m_patch_of_texel.size(); ++i)
        if (uint32_t& patch = m_patch_of_texel[i]; patch != kNone)
            patch += m_tiles[i / width / kTileSize * across + i % width / kTileSize].first;
}

uint32_t MapPatches::find(uint32_t triangle, float u, float v) const
{
    const uint32_t baked = baked_triangle(triangle);
    const Mesh& mesh = m_map.scene().mesh();
    if (baked == kNone)
        return kNone;
    const auto& [a, b, c] = mesh.triangles[baked];
    const V2d first(mesh.uvs[a]);
    const V2d uv = first + (V2d(mesh.uvs[b]) - first) * double(u) + (V2d(mesh.uvs[c]) - first) * double(v)
        - V2d(udim_corner(m_map.params().udim));
    const int width = m_map.width(), height = m_map.height();
    const double x = uv.x * width, y = (1 - uv.y) * height;
    if (!(x > -1 && x < width + 1 && y > -1 && y < height + 1)) // nor not a number
        return kNone;
    const int column = int(std::floor(x)), row = int(std::floor(y));
    const uint32_t island = m_island_of_triangle[baked];
    const auto patch_at = [&](int i, int j) {
        if (i < 0 || i >= width || j < 0 || j >= height)
            return kNone;
        const uint32_t patch = m_patch_of_texel[size_t(j) * size_t(width) + size_t(i)];
        return patch != kNone && m_islands[patch] == island ? patch : kNone;
    };
    uint32_t nearest = patch_at(column, row);
    if (nearest != kNone)
        return nearest;
    double least = 9;
    for (int j = row - 1; j <= row + 1; ++j)
        for (int i = column - 1; i <= column + 1; ++i) {
            const double distance = std::pow(i + 0.5 - x, 2) + std::pow(j + 0.5 - y, 2);
            const uint32_t patch = distance < least ? patch_at(i, j) : kNone;
            if (patch != kNone) {
                nearest = patch;
                least = distance;
            }
        }
    return nearest;
}

void MapPatches::average(V3f* dst, const float* rgb, int nthreads) const
{
    std::fill(dst, dst + count(), V3f(0));
    const auto add = [&](int64_t tile, int) {
        const uint32_t first = m_tiles[size_t(tile)].first;
        const uint32_t end = size_t(tile) + 1 < m_tiles.size() ? m_tiles[size_t(tile) + 1].first : count();
        std::vector<float> texels(end - first);
        const int left = m_map.left(int(tile)), top = m_map.top(int(tile));
        for (int y = top; y < std::min(top + kTileSize, m_map.height()); ++y)
            for (int x = left; x < std::min(left + kTileSize, m_map.width()); ++x) {
                const size_t texel = size_t(y) * size_t(m_map.width()) + size_t(x);
                const uint32_t patch = m_patch_of_texel[texel];
                if (patch == kNone)
                    continue;
                dst[patch] += V3f(rgb[3 * texel], rgb[3 * texel + 1], rgb[3 * texel + 2]);
                ++texels[patch - first];
            }
        for (uint32_t patch = first; patch < end; ++patch)
            dst[patch] /= texels[patch - first];
    };
    parallel_items(int64_t(m_tiles.size()), nthreads, add);
}

size_t MapPatches::bytes() const
{
    return sizeof(uint32_t)
        * (m_patch_of_texel.capacity() + m_islands.capacity() + m_baked_triangle.capacity()
           + m_island_of_triangle.capacity());
}

} // namespace vmlight
