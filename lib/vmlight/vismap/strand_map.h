// SPDX-License-Identifier: Apache-2.0
/// Visibility maps of strands: what a hair's surroundings let through to it, around its tangent t,
///     V = (1/pi^2) Int vis(w) sin(t, w) dw,   B = (1/pi^2) Int vis(w) sin(t, w) w dw,
/// over the whole sphere: an open strand has V = 1 and B = 0.
/// Source: J. Kajiya, T. Kay, "Rendering Fur with Three Dimensional Textures", SIGGRAPH 1989 (the diffuse term).
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/math/strand_pattern.h>
#include <vmlight/mesh/strands.h>
#include <vmlight/trace/strand_scene.h>
#include <vmlight/vismap/vismap.h>

#include <Imath/ImathVec.h>
#include <OpenImageIO/imagebuf.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// Where strands are in a map. Each is `texels` wide, from root to tip along x, and one texel high. Strand `rows` is to
/// the right of strand 0, so that the map is about square.
struct StrandLayout
{
    int64_t strands = 0;
    int texels = 0, rows = 0;

    /// The rows that `strands` of `texels` each get. False, with the reason in `error`, if a side would be longer than
    /// 32768.
    static bool make(StrandLayout& dst, size_t strands, int texels, std::string& error);

    Size size() const;
    /// The strand of texel (x, y); `strands` if it has none.
    int64_t strand_at(int x, int y) const;
    /// The texels of a strand.
    OIIO::ROI roi(int64_t strand) const;
    /// How far from root to tip the centre of column x is, as a share of the strand's length.
    double share_at(int x) const { return (x % texels + 0.5) / texels; }
    /// Where a texture lookup finds the point of a strand at this share of its length: v up, between texel centres of
    /// this strand alone.
    Imath::V2d uv(int64_t strand, double share) const;
};

/// StrandLayout::uv() of each point, where its curve passes it. float: the nearest to the texels' centres.
std::vector<Imath::V2f> strand_uvs(const Strands& strands, const StrandLayout& layout);

/// Whether `key` of a vismap recipe is one that maps of strands use.
bool is_strand_parameter(const std::string& key);

/// Size, channels and metadata of a map: `visibility`, `direction.x/y/z`, `tangent.x/y/z` and those of the basis.
OIIO::ImageSpec describe_strand_map(const Strands& strands, const StrandLayout& layout,
                                    const StrandParams& strand_params, const VismapParams& params);

/// Bakes texels. Thread-safe.
class StrandBaker
{
public:
    /// @param strands, scene  of these strands; must outlive this
    /// @param params   `samples`, `sampler`, `seed`, `max_distance`, `basis` and `order` count
    StrandBaker(const Strands& strands, const StrandScene& scene, const StrandLayout& layout,
                const VismapParams& params);

    /// Set `dst` to the float pixels of `roi`, all channels of describe_strand_map(), rows without padding. A function
    /// of strands, scene, parameters and texel alone. Texels without a strand are 0.
    /// @returns the number of rays traced
    int64_t bake(OIIO::ROI roi, float* dst) const;

    const Strands& strands() const { return m_strands; }
    const StrandLayout& layout() const { return m_layout; }

private:
    class Point;

    const Strands& m_strands;
    const StrandScene& m_scene;
    const StrandLayout m_layout;
    const VismapParams m_params;
    const StrandPattern m_pattern;
    const int m_basis_count;
};

/// Bake a whole map on threads. The result is the same bits for every number of them.
/// @param rays     set to the number of rays traced
/// @returns false, with the reason in `dst.geterror()`, if memory runs out or `progress` stopped the work.
bool make_strand_map(OIIO::ImageBuf& dst, const OIIO::ImageSpec& spec, const StrandBaker& baker, int nthreads,
                     int64_t& rays, const Progress& progress = {});

} // namespace vmlight
