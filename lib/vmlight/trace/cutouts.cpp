// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/cutouts.h>

#include <vmlight/base/parallel.h>
#include <vmlight/base/unique_index.h>

#include <algorithm>
#include <cstring>

namespace vmlight {
namespace {

using Imath::V2f;

// Of all micromaps of a mesh: half a MiB, which a core's cache holds; beyond it all have fewer levels. Measured on 1600
// leaves, each with uvs of its own: to wait for cells from memory takes longer than to look up the texture.
constexpr int64_t kMostCells = int64_t(1) << 21;
// Triangles that a thread takes at once.
constexpr size_t kPortion = 64;

// What the micromap of a triangle depends on, without padding: keys are compared byte by byte.
struct MapKey
{
    std::array<std::array<V2f, 3>, 2> uvs;
    uint32_t material;
};

// Source: G. Steele, D. Lea, C. Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014 (SplitMix64).
uint64_t hash_bits(uint64_t z)
{
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

const MaterialOpacity* material_of(const Mesh& mesh, size_t triangle)
{
    if (triangle >= mesh.triangle_materials.size()
        || mesh.triangle_materials[triangle] >= mesh.opacity->materials.size())
        return nullptr;
    const MaterialOpacity& material = mesh.opacity->materials[mesh.triangle_materials[triangle]];
    return material.mode == AlphaMode::opaque ? nullptr : &material;
}

template <class Work> void in_portions(size_t count, int nthreads, const Work& work)
{
    parallel_items(int64_t((count + kPortion - 1) / kPortion), nthreads, [&](int64_t portion, int) {
        for (size_t i = size_t(portion) * kPortion; i < std::min(count, size_t(portion + 1) * kPortion); ++i)
            work(i);
    });
}

// The greatest level for which all micromaps together have few enough cells.
int deepest_level(const std::vector<int>& levels)
{
    for (int deepest = MicromapGrid::kDeepest; deepest > 0; --deepest) {
        int64_t cells = 0;
        for (const int level : levels)
            cells += MicromapGrid { std::min(level, deepest) }.count();
        if (cells <= kMostCells)
            return deepest;
    }
    return 0;
}

} // namespace

void CutoutCounts::add(const CutoutCounts& other)
{
    triangles += other.triangles;
    opaque += other.opaque;
    transparent += other.transparent;
    mixed += other.mixed;
    cells += other.cells;
    unknown += other.unknown;
    bytes += other.bytes;
}

std::unique_ptr<const Cutouts> Cutouts::make(const Mesh& mesh, uint32_t caster, int nthreads, CutoutMode mode)
{
    if (!mesh.opacity)
        return nullptr;
    std::vector<uint32_t> candidates;
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
        if (material_of(mesh, t))
            candidates.push_back(uint32_t(t));
    if (candidates.empty())
        return nullptr;
    std::unique_ptr<Cutouts> result(new Cutouts);
    result->m_opacity = mesh.opacity;
    result->m_caster = caster;
    result->sort(mesh, candidates, nthreads, mode);
    return result;
}

void Cutouts::sort(const Mesh& mesh, const std::vector<uint32_t>& candidates, int nthreads, CutoutMode mode)
{
    // Leaves of one kind have the same uvs, and share a micromap.
    UniqueIndex<MapKey> keys(candidates.size());
    std::vector<uint32_t> key_of(candidates.size());
    for (size_t i = 0; i < candidates.size(); ++i) {
        MapKey key { {}, mesh.triangle_materials[candidates[i]] };
        const MaterialOpacity& material = *material_of(mesh, candidates[i]);
        for (size_t k = 0; k < key.uvs.size(); ++k) {
            key.uvs[k].fill(V2f(0));
            if (material.textures[k].image)
                key.uvs[k] = texture_uvs(mesh, candidates[i], material.textures[k]);
        }
        key_of[i] = keys.index_of(key);
    }
    const size_t count = keys.keys().size();
    const auto triangle = [&](size_t key) {
        return TriangleOpacity(m_opacity->materials[keys.keys()[key].material], keys.keys()[key].uvs);
    };
    std::vector<int> levels(count, 0);
    std::vector<OpacityMicromap> maps(count);
    in_portions(count, nthreads, [&](size_t key) { levels[key] = micromap_level(triangle(key)); });
    const int deepest = deepest_level(levels);
    in_portions(count, nthreads, [&](size_t key) {
        maps[key] = make_micromap(triangle(key), std::min(levels[key], deepest));
        if (mode == CutoutMode::every_hit) { // but the same pieces of triangles are traced
            OpacityMicromap asked;
            asked.stopping = maps[key].stopping;
            maps[key] = asked;
        }
    });
    std::vector<size_t> first_word(count, 0);
    for (size_t key = 0; key < count; ++key) {
        if (maps[key].whole != CellState::unknown)
            continue;
        first_word[key] = m_cells.size();
        m_cells.insert(m_cells.end(), maps[key].cells.begin(), maps[key].cells.end());
    }

    size_t next = 0;
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (next == candidates.size() || candidates[next] != t) {
            m_opaque.push_back(uint32_t(t));
            continue;
        }
        const uint32_t key = key_of[next++];
        const OpacityMicromap& map = maps[key];
        ++m_counts.triangles;
        if (map.whole == CellState::transparent) {
            ++m_counts.transparent;
        } else if (map.whole == CellState::opaque) {
            ++m_counts.opaque;
            m_opaque.push_back(uint32_t(t));
        } else {
            ++m_counts.mixed;
            m_counts.cells += map.grid.count();
            m_counts.unknown += map.cells.empty() ? map.grid.count() : map.unknown;
            m_mixed.push_back(uint32_t(t));
            m_maps.push_back({ first_word[key], map.grid, map.stopping });
            m_material_of.push_back(keys.keys()[key].material);
            m_uvs.push_back(keys.keys()[key].uvs);
        }
    }
    m_counts.bytes
        = m_cells.size() * sizeof(uint64_t) + m_mixed.size() * (sizeof(m_uvs[0]) + sizeof(Map) + 2 * sizeof(uint32_t));
    for (const MaterialOpacity& material : m_opacity->materials)
        for (const MaterialOpacity::Texture& texture : material.textures)
            m_counts.bytes += texture.image ? texture.image->bytes() : 0;
}

double Cutouts::opacity(uint32_t mixed, double u, double v, CutoutWork& work) const
{
    ++work.hits;
    const Map& map = m_maps[mixed];
    if (!m_cells.empty())
        if (const CellState found = state(map, size_t(map.grid.cell(u, v))); found != CellState::unknown)
            return found == CellState::opaque ? 1 : 0;
    ++work.lookups;
    return TriangleOpacity(m_opacity->materials[m_material_of[mixed]], m_uvs[mixed]).at(u, v);
}

bool Cutouts::operator==(const Cutouts& other) const
{
    if (m_opaque != other.m_opaque || m_mixed != other.m_mixed || m_material_of != other.m_material_of
        || m_opacity->materials != other.m_opacity->materials)
        return false;
    for (size_t i = 0; i < m_uvs.size(); ++i)
        for (size_t t = 0; t < 2; ++t) // by their bits: uvs that are missing are NaN
            if (m_opacity->materials[m_material_of[i]].textures[t].image
                && std::memcmp(&m_uvs[i][t], &other.m_uvs[i][t], sizeof(m_uvs[i][t])) != 0)
                return false;
    return true;
}

bool Cutouts::passes(uint32_t mixed, double opacity, uint64_t ray) const
{
    const uint64_t place = uint64_t(m_caster) << 32 | m_mixed[mixed];
    const uint64_t random = hash_bits(ray ^ hash_bits(place + 0x9e3779b97f4a7c15u));
    return double(random >> 11) * 0x1p-53 >= opacity;
}

} // namespace vmlight
