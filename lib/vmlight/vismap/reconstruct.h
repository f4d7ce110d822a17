// SPDX-License-Identifier: Apache-2.0
/// Reconstruction: V, B and the bands of `sh` of a texel from its own rays and those of its neighbours, where they see
/// the same. A step between the bake and the margin.
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/vismap/island_layers.h>
#include <vmlight/vismap/neighbour_weights.h>
#include <vmlight/vismap/vismap.h>

#include <Imath/ImathVec.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// Why maps of these parameters are not reconstructed, a phrase, or "".
std::string reconstruct_fault(const VismapParams& params);

/// Whether they are.
inline bool is_reconstructed(const VismapParams& params)
{
    return reconstruct_fault(params).empty();
}

/// Bytes that the reconstruction of a whole map takes besides the map: the texels as they were baked, and their
/// contexts. 0 if it is not reconstructed.
double reconstruct_bytes(const VismapParams& params);

/// "" if a whole map of these parameters fits in memory with its reconstruction, else the reason why not, and whether
/// it fits without.
/// @param spec     of the map
std::string map_memory_shortage(const OIIO::ImageSpec& spec, const VismapParams& params);

/// What a bake knows of a texel beside its channels.
struct TexelContext
{
    Imath::V3f position { 0 }, normal { 0 }; ///< in the scene's space; of unit length
    float spacing = 0; ///< the longest distance to the next texel, in the scene's space; 0: not covered
    float variance = 0; ///< of V, if its rays were independent
    uint32_t island = 0; ///< SeamLinks::island()
};

/// The contexts of a rectangle of texels.
struct TexelContexts
{
    TexelContexts() = default;
    TexelContexts(int the_left, int the_top, int the_width, int the_height)
        : left(the_left)
        , top(the_top)
        , width(the_width)
        , height(the_height)
        , texels(size_t(the_width) * size_t(the_height))
    {
    }
    TexelContext& at(int x, int y) { return texels[index(x, y)]; }
    const TexelContext& at(int x, int y) const { return texels[index(x, y)]; }

    int left = 0, top = 0, width = 0, height = 0;
    std::vector<TexelContext> texels;

private:
    size_t index(int x, int y) const { return size_t(y - top) * size_t(width) + size_t(x - left); }
};

class Harmonics;

/// Reconstructs one tile at a time. One per thread.
class Reconstruction
{
public:
    /// @param params   is_reconstructed()
    /// @param pattern_error, error_scale  as in SampleCount
    Reconstruction(const VismapParams& params, double pattern_error, double error_scale = 1);
    ~Reconstruction();

    /// Forget all texels.
    void clear() { m_window.clear(); }
    /// Add a covered texel at (x, y) from the first of the tile: at least -NeighbourWindow::kHalo, and less than
    /// kTileSize + kHalo. In any order.
    void add(int x, int y, const float* texel, const TexelContext& context);
    /// Once all covered texels are added, set those of the tile. A texel stays as it is, to the bit, if none of the 3x3
    /// around it has a variance: all their rays are free, or all are blocked, or the ground alone blocks them. None
    /// moves farther than the scatter of the rays around it explains.
    ///
    /// @param raw, texels  the tile's first texel, as it was baked and to be set; rows are `pitch` floats apart
    /// @param contexts     has those of the tile
    /// @param continuations    what is where islands end, instead of what was added there
    /// @returns how many of them have V below 0.01
    int64_t apply(const float* raw, float* texels, size_t pitch, int left, int top, const TexelContexts& contexts,
                  const std::vector<Continuation>& continuations = {});

private:
    void want_scattered(const std::array<uint64_t, kTileSize>& texels);
    void apply_layer(const float* raw, float* texels, size_t pitch, int left, int top, const TexelContexts& contexts);
    void change_bands(const float* raw, float* texels, size_t pitch, const std::vector<size_t>& changed);

    struct Layout
    {
        size_t channels, error_at, bands_at;
        int order; // 0: no bands
        bool has_error;
    };
    const Layout m_layout;
    const double m_pattern_error;
    const float m_error_scale;
    NeighbourWindow m_window;
    std::vector<NeighbourWindow::Plane*> m_planes; // all that add() sets
    std::unique_ptr<Harmonics> m_harmonics;
    std::vector<NeighbourWindow::Plane> m_bands, m_open; // less those of an open texel of the same V; and those, by V
    std::vector<float> m_values;
    std::array<std::vector<float>, 4> m_change;
    std::vector<float> m_narrowed, m_kept, m_band_change;
};

} // namespace vmlight
