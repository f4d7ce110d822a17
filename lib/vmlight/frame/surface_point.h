// SPDX-License-Identifier: Apache-2.0
/// Where a camera ray meets a triangle: in double, so that a texture seen at 1:1 keeps its texels.
#pragma once

#include <vmlight/frame/camera.h>
#include <vmlight/frame/texture_pyramid.h>
#include <vmlight/mesh/mesh.h>

#include <array>
#include <cstdint>

namespace vmlight {

struct FramePoint
{
    /// In units of the ray's direction: the depth along the camera's forward axis.
    double depth = 0;
    Imath::V3d position;
    /// Weights of the triangle's corners, and how they change from pixel to pixel: their sums are 1, 0 and 0.
    std::array<double, 3> weight, weight_dx, weight_dy;

    /// The value at the point of what is given at the corners.
    template <class T> T mix(const T& a, const T& b, const T& c) const
    {
        return a * weight[0] + b * weight[1] + c * weight[2];
    }
    /// The uv of the point and of its neighbours.
    TextureFootprint footprint(const std::array<Imath::V2d, 3>& uvs) const;
    /// The interpolated normal, of unit length, or the zero vector.
    Imath::V3d normal(const Mesh& mesh, uint32_t triangle) const;
};

/// Intersect a ray with the plane of a triangle. False if the triangle has no area or the ray runs along it.
/// Source: H. Igehy, "Tracing Ray Differentials", SIGGRAPH 1999, 3.1.
bool intersect_plane(FramePoint& dst, const CameraRay& ray, const Mesh& mesh, uint32_t triangle);

} // namespace vmlight
