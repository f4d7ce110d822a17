// SPDX-License-Identifier: Apache-2.0
/// Baking by tile: make_vismap() bakes all tiles of a map, a reader those that are asked for. Neither their order nor
/// what else is baked changes a bit.
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/uv/margin.h>
#include <vmlight/uv/raster.h>
#include <vmlight/vismap/normal_map.h>
#include <vmlight/vismap/open_triangles.h>
#include <vmlight/vismap/sample_count.h>
#include <vmlight/vismap/seam_links.h>
#include <vmlight/vismap/vismap.h>

#include <OpenImageIO/imageio.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// Size, channels and metadata of the map that `params` ask for, except what depends on the mesh, such as the samples
/// for a target error.
OIIO::ImageSpec describe_vismap(const std::string& mesh_name, const VismapParams& params);

/// Which of a map's channels, in the order of describe_vismap(), the margin fills, and how.
MarginChannels margin_channels_of(const std::vector<std::string>& names);

/// make_vismap() from a scene that other maps may share. With a `time_budget`, in seconds, the bake traces as many rays
/// per texel as it has time for on this machine, at least one; the report has their number. `at_step` hears of the
/// steps before and after those of `progress`.
bool make_vismap(OIIO::ImageBuf& dst, const BakeScenePointer& scene, const VismapParams& params, VismapReport* report,
                 int nthreads, const Progress& progress, double time_budget = 0, NormalMapPointer normal_map = nullptr,
                 const StepListener& at_step = {});

/// Counts of a bake, or of some tiles of it.
struct BakeCounts
{
    int64_t covered = 0, overlapping = 0, dark = 0, rays = 0, open = 0;
    int64_t tiles = 0; ///< with a covered texel
    void add(const BakeCounts& other);
};

/// The covered texels of a tile: bit x of word y.
using TileBits = std::array<uint64_t, kTileSize>;

struct BakeHints;

class VismapBaker
{
public:
    VismapBaker();
    ~VismapBaker();

    /// Prepare what the tiles of this map share: the UV raster of its UDIM tile, the sample pattern, and, for a target
    /// error or a time budget, the number of rays, for which some texels are baked twice.
    ///
    /// @param scene    built; other maps may share it
    /// @param time_budget as for make_vismap()
    /// @param progress called with 0; returning false stops the work
    /// @param normal_map nullptr, or a map of this size and mesh
    /// @returns false, with the reason in `error`, if a parameter is out of range, the target error is out of reach,
    ///          the basis needs another measure, or `progress` stopped it
    bool prepare(BakeScenePointer scene, const VismapParams& params, std::string& error, int nthreads = 0,
                 const Progress& progress = {}, double time_budget = 0, NormalMapPointer normal_map = nullptr);

    /// The same, with a scene of its own.
    ///
    /// @param mesh     must outlive the baker; `occluders` need not
    /// @returns false, with the reason in `error`, if a parameter is out of range, the mesh has no triangle or no uvs,
    ///          or memory runs out
    bool prepare(const Mesh& mesh, const std::vector<Mesh>& occluders, const VismapParams& params, int nthreads,
                 std::string& error);

    // After prepare().
    int width() const;
    int height() const;
    int channels() const;
    /// Which of them the margin fills, and how.
    MarginChannels margin_channels() const;
    int tiles_across() const;
    int tiles_down() const;
    const UvRaster& raster() const;
    const UvReport& uv_report() const;
    /// Fill in the counts of islands, which uv_report() leaves out.
    void count_islands(UvReport& report) const;
    /// The parameters, with the chosen number of rays; and its error.
    const VismapParams& params() const;
    const SampleCount& error() const;
    /// Which triangles trace no ray.
    const OpenTriangles& open() const;
    /// The seams between its islands; none unless it is reconstructed.
    const SeamLinks& seams() const;

    /// Working memory of one thread.
    class Scratch;
    struct FreeScratch
    {
        void operator()(Scratch*) const;
    };
    using ScratchPointer = std::unique_ptr<Scratch, FreeScratch>;
    ScratchPointer scratch() const;

    /// Find the covered texels of tile number `tile` (row by row). Traces no ray. Any thread, with a scratch of its
    /// own.
    void cover_tile(int tile, Scratch& scratch, TileBits& covered) const;

    /// Count the texels of tile number `tile` that are covered, overlapping and open. Traces no ray. Any thread, with a
    /// scratch of its own.
    BakeCounts count_tile(int tile, Scratch& scratch) const;

    /// Bake tile number `tile`. Any thread, with a scratch of its own.
    ///
    /// @param texels   the tile's first texel, of channels() floats; rows are `pitch` floats apart. Texels that no
    ///                 triangle covers are not written: there is no margin yet
    /// @param hints    nullptr, or more about the tile. Texels not in its `only` are neither traced nor written, nor
    ///                 counted as dark or open
    BakeCounts bake_tile(int tile, Scratch& scratch, float* texels, size_t pitch, TileBits& covered,
                         const BakeHints* hints = nullptr) const;

    /// Bake every tile into the whole map. False if `progress` stopped it.
    bool bake_all(float* texels, Coverage& covered, BakeCounts& counts, int nthreads, const Progress& progress = {},
                  const BakeHints* hints = nullptr) const;

private:
    int before_basis() const;

    struct Setup;
    std::unique_ptr<Setup> m_setup;
};

} // namespace vmlight
