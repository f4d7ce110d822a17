// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/base/params.h>

#include <string>

namespace vmlight {

/// How a normal map is to be understood.
struct NormalMapParams
{
    /// `tangent`: R along +u, G along +v, B along the mesh's normal, in the tangents of MikkTSpace (mesh/tangents.h).
    /// `object`: x, y, z of object space.
    std::string normal_map_space = "tangent";
    /// `up`: G is along +v, as OpenGL, glTF, Blender and Substance's "OpenGL" have it; `down`: as Direct3D and Unreal.
    std::string normal_map_green = "up";

    template <class Visit> void visit(Visit&& field)
    {
        field("normal_map_space", normal_map_space,
              Choices { { { "tangent", "relative to the mesh's normals and UVs" },
                          { "object", "x, y and z of the mesh's own space" } } },
              advanced("What the channels of the normal map mean"));
        field("normal_map_green", normal_map_green,
              Choices { { { "up", "OpenGL: green is up in the texture" }, { "down", "DirectX: green is down" } } },
              "Direction of the green channel of the normal map");
    }
};

} // namespace vmlight
