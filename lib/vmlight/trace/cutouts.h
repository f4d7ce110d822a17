// SPDX-License-Identifier: Apache-2.0
/// Cut-outs: which triangles rays pass, and where. Opaque triangles are traced as ever, transparent ones are left out,
/// and the rest is asked hit by hit.
#pragma once

#include <vmlight/mesh/mesh.h>
#include <vmlight/mesh/opacity.h>
#include <vmlight/trace/opacity_micromap.h>

#include <Imath/ImathVec.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace vmlight {

/// What a scene has of cut-outs. All 0 where all is opaque.
struct CutoutCounts
{
    int64_t triangles = 0; ///< with a material that is not opaque everywhere
    int64_t opaque = 0, transparent = 0, mixed = 0; ///< of those
    int64_t cells = 0, unknown = 0; ///< of the mixed ones; those that ask the texture
    size_t bytes = 0;

    void add(const CutoutCounts& other);
};

/// Work of rays at mixed triangles.
struct CutoutWork
{
    int64_t hits = 0; ///< that a filter was asked about
    int64_t lookups = 0; ///< of those, by texture
};

enum class CutoutMode
{
    micromaps,
    every_hit ///< ask the texture at every hit. The same result, for tests and benchmarks
};

/// The cut-outs of one mesh. Thread-safe once made.
class Cutouts
{
public:
    /// @param mesh     need not outlive this; its triangles may lie outside its list of materials
    /// @param caster   its number among the meshes of the scene
    /// @returns nullptr if no triangle has a material that is not opaque
    static std::unique_ptr<const Cutouts> make(const Mesh& mesh, uint32_t caster, int nthreads,
                                               CutoutMode mode = CutoutMode::micromaps);

    const CutoutCounts& counts() const { return m_counts; }
    /// The triangles that stop all light, in the mesh's order, and those that must be asked.
    const std::vector<uint32_t>& opaque() const { return m_opaque; }
    const std::vector<uint32_t>& mixed() const { return m_mixed; }

    /// Weights of the points of one of mixed() that are not transparent.
    const WeightRange& stopping(uint32_t mixed) const { return m_maps[mixed].stopping; }

    /// Opacity at a hit, from 0 to 1.
    ///
    /// @param mixed        an index into mixed()
    /// @param u, v         barycentric weights of the triangle's second and third corners
    double opacity(uint32_t mixed, double u, double v, CutoutWork& work) const;

    /// What its micromap says of a hit whose weights are not exact: unknown unless all points within `error` of them
    /// lie in one cell that is opaque or transparent. Never disagrees with opacity().
    CellState known(uint32_t mixed, float u, float v, float error) const
    {
        const Map& map = m_maps[mixed];
        const int64_t cell = map.grid.cell_within(u, v, error);
        return cell < 0 || m_cells.empty() ? CellState::unknown : state(map, size_t(cell));
    }

    /// Whether light passes where opacity is in between: by a hash of the ray and the triangle. Its mean is exact, and
    /// no threads, tiles or order of hits change it.
    ///
    /// @param ray          bits that identify the ray
    bool passes(uint32_t mixed, double opacity, uint64_t ray) const;

    /// Whether light passes the same points of the same triangles.
    bool operator==(const Cutouts& other) const;

private:
    struct Map
    {
        size_t first_word; ///< into m_cells
        MicromapGrid grid;
        WeightRange stopping;
    };

    CellState state(const Map& map, size_t cell) const
    {
        return CellState(m_cells[map.first_word + cell / 32] >> (2 * (cell % 32)) & 3);
    }
    void sort(const Mesh& mesh, const std::vector<uint32_t>& candidates, int nthreads, CutoutMode mode);

    std::shared_ptr<const MeshOpacity> m_opacity;
    uint32_t m_caster = 0;
    CutoutCounts m_counts;
    std::vector<uint32_t> m_opaque, m_mixed;
    // For each of the mixed triangles: its micromap, which triangles with equal uvs share, its material, its uvs.
    std::vector<Map> m_maps;
    std::vector<uint32_t> m_material_of;
    std::vector<std::array<std::array<Imath::V2f, 3>, 2>> m_uvs;
    std::vector<uint64_t> m_cells;
};

} // namespace vmlight
