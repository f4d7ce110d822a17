// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/layers.h>

#include <algorithm>
#include <cmath>

namespace vmlight {
namespace {

template <class Vector> void store(const Vector& v, float* dst)
{
    dst[0] = float(v.x);
    dst[1] = float(v.y);
    dst[2] = float(v.z);
}

// Blender writes the same number where nothing is.
constexpr float kFarAway = 1e10f;

} // namespace

const std::vector<FrameLayer>& frame_layers()
{
    static const std::vector<FrameLayer> layers {
        { "albedo",
          "colour of the material",
          { "albedo.R", "albedo.G", "albedo.B" },
          true,
          0,
          false,
          [](const SeenPoint& seen, float* dst) { store(seen.albedo, dst); } },
        { "lit",
          "light of a white surface",
          { "lit.R", "lit.G", "lit.B" },
          true,
          0,
          false,
          [](const SeenPoint& seen, float* dst) { store(seen.light, dst); } },
        { "visibility",
          "V of the visibility map",
          { "visibility" },
          true,
          0,
          true,
          [](const SeenPoint& seen, float* dst) { dst[0] = seen.visibility[0]; } },
        { "direction",
          "B of the visibility map, object space",
          { "direction.x", "direction.y", "direction.z" },
          true,
          0,
          true,
          [](const SeenPoint& seen, float* dst) { std::copy_n(seen.visibility.data() + 1, 3, dst); } },
        { "normal",
          "shading normal, object space",
          { "normal.x", "normal.y", "normal.z" },
          true,
          0,
          false,
          [](const SeenPoint& seen, float* dst) {
              store(seen.surface->strands ? seen.strand_normal : seen.point.normal(*seen.surface->mesh, seen.triangle),
                    dst);
          } },
        { "position",
          "object space, unfiltered",
          { "position.x", "position.y", "position.z" },
          false,
          0,
          false,
          [](const SeenPoint& seen, float* dst) { store(seen.point.position, dst); } },
        { "uv",
          "of the map, unfiltered",
          { "uv.u", "uv.v" },
          false,
          0,
          false,
          [](const SeenPoint& seen, float* dst) {
              // A triangle without UVs has none.
              dst[0] = std::isfinite(seen.uv.st.x) ? float(seen.uv.st.x) : 0;
              dst[1] = std::isfinite(seen.uv.st.y) ? float(seen.uv.st.y) : 0;
          } },
        { "depth",
          "along the view axis, in mesh units, unfiltered; 1e10 where nothing is",
          { "depth.Z" },
          false,
          kFarAway,
          false,
          [](const SeenPoint& seen, float* dst) { dst[0] = float(seen.point.depth); } },
        { kCoverageLayer,
          "alpha of the objects, whatever is behind",
          { "coverage" },
          true,
          0,
          false,
          [](const SeenPoint&, float* dst) { dst[0] = 1; } },
    };
    return layers;
}

ChoiceSet frame_layer_choices()
{
    ChoiceSet set;
    for (const FrameLayer& layer : frame_layers())
        set.choices.push_back({ layer.name, layer.meaning });
    return set;
}

} // namespace vmlight
