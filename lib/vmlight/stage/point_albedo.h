// SPDX-License-Identifier: Apache-2.0
/// The albedo of points that light the texels of a map: of the mesh, its occluders and the ground.
#pragma once

#include <vmlight/base/file_stamp.h>
#include <vmlight/stage/make_options.h>
#include <vmlight/stage/map_scene.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/vismap/light_transport.h>

#include <Imath/ImathVec.h>

#include <functional>
#include <string>
#include <vector>

namespace vmlight {

/// The albedo of a point of an occluder that is in memory. Any thread.
using CasterColor = std::function<Imath::V3f(const LightPoint& point)>;

class PointAlbedo
{
public:
    /// Find the albedo of all `points` but those of the mesh: that of the ground, and for occluders, `color` of them.
    void find(const MapScene& scene, const std::vector<LightPoint>& points, const Imath::V3f& ground,
              const CasterColor& color);
    /// Find the albedo of all `points` but those of the mesh: base colours of occluders are those of their files, with
    /// the mean of their textures; where a file has none, and for what cannot be read, it is the recipe's
    /// `bounce_albedo`. Reads each occluder that has points again.
    ///
    /// @param space    interop id of the light's space
    /// @returns false, with the reason in `error`, if an occluder cannot be read, or a colour cannot be converted
    bool read(const MapScene& scene, const std::vector<LightPoint>& points, const LightmapRecipe& recipe,
              const std::string& space, const MakeOptions& options, std::string& error);

    /// Multiply `light`, three floats for each point. Those of the mesh have the albedo of the texel that their uvs are
    /// in, or the mean over all texels where that is another part or tile.
    ///
    /// @param albedo   three floats for each texel of the map
    /// @param map      says which texels the mesh covers
    void multiply(std::vector<float>& light, const std::vector<float>& albedo, const LightTransport& map) const;

    /// After read(): whether some point has the recipe's `bounce_albedo`.
    bool uses_bounce_albedo() const { return m_uses_bounce_albedo; }

    /// The files that occluders' colours were read from.
    const std::vector<FileStamp>& files() const { return m_files; }

private:
    struct Source
    {
        static constexpr int kColor = -1, kMean = -2;
        int texel; // its index in the map; or one of these
        Imath::V3f color { 0 };
    };
    // The texel, in a map of the tile, that a point of the baked mesh has its uvs in; or Source::kMean.
    static int texel_of(const MapScene& scene, const LightPoint& point);

    std::vector<Source> m_sources; // of each point
    std::vector<FileStamp> m_files;
    bool m_uses_bounce_albedo = false;
};

} // namespace vmlight
