// SPDX-License-Identifier: Apache-2.0
/// The work behind a visibility map, tile by tile: what make_vismap() does for a whole map, a reader does for the tiles
/// that are asked for. Neither the order of tiles nor what else is baked changes a bit.
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/uv/margin.h>
#include <vmlight/uv/raster.h>
#include <vmlight/vismap/sample_count.h>
#include <vmlight/vismap/vismap.h>

#include <OpenImageIO/imageio.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// The map that `params` ask for: size, channels and metadata, but for what takes the mesh itself to know, as the
/// samples that a target error takes do.
OIIO::ImageSpec describe_vismap(const std::string& mesh_name, const VismapParams& params);

/// make_vismap(), from a scene that other maps may share. With a `time_budget`, in seconds, the samples are those that
/// the bake has time for on this machine, and at least one; the report tells.
bool make_vismap(OIIO::ImageBuf& dst, const BakeScenePointer& scene, const VismapParams& params, VismapReport* report,
                 int nthreads, const Progress& progress, double time_budget = 0);

/// What was baked.
struct BakeCounts
{
    int64_t covered = 0, overlapping = 0, dark = 0, rays = 0;
    int64_t tiles = 0; ///< with a covered texel
    void add(const BakeCounts& other);
};

/// Which texels of a tile are covered: bit x of word y.
using TileBits = std::array<uint64_t, kTileSize>;

class VismapBaker
{
public:
    VismapBaker();
    ~VismapBaker();

    /// Build what the tiles of this map share: the UV raster of its UDIM tile, the directions; bake some texels twice,
    /// where an error or a time was asked for. The scene it shares with others.
    ///
    /// @param scene    built
    /// @param time_budget as for make_vismap()
    /// @returns false, with the reason in `error`, if a parameter is out of range, the error is out of reach, or
    ///          `progress`, which is told 0, stopped it
    bool prepare(BakeScenePointer scene, const VismapParams& params, std::string& error, int nthreads = 0,
                 const Progress& progress = {}, double time_budget = 0);

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
    /// How many of them the margin has too.
    MarginChannels margin_channels() const;
    int tiles_across() const;
    int tiles_down() const;
    const UvReport& uv_report() const;
    /// Fill in what uv_report() leaves out.
    void count_islands(UvReport& report) const;
    /// With the samples that it bakes with; and what they come to.
    const VismapParams& params() const;
    const SampleCount& error() const;

    /// What one thread needs while it bakes.
    class Scratch;
    struct FreeScratch
    {
        void operator()(Scratch*) const;
    };
    using ScratchPointer = std::unique_ptr<Scratch, FreeScratch>;
    ScratchPointer scratch() const;

    /// Which texels tile number `tile` (row by row) covers: no ray is traced. Any thread, with a scratch of its own.
    void cover_tile(int tile, Scratch& scratch, TileBits& covered) const;

    /// Bake tile number `tile`. Any thread, with a scratch of its own.
    ///
    /// @param texels   the tile's first texel, of channels() floats; rows are `pitch` floats apart. Texels that no
    ///                 triangle covers are left as they are: there is no margin yet
    BakeCounts bake_tile(int tile, Scratch& scratch, float* texels, size_t pitch, TileBits& covered) const;

    /// Bake every tile into the whole map. False if `progress` stopped it.
    bool bake_all(float* texels, Coverage& covered, BakeCounts& counts, int nthreads,
                  const Progress& progress = {}) const;

private:
    int before_basis() const;

    struct Setup;
    std::unique_ptr<Setup> m_setup;
};

} // namespace vmlight
