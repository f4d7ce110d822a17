// SPDX-License-Identifier: Apache-2.0
/// Which places of a mesh Embree is given as instances, and which as triangles of their own.
#pragma once

#include <vmlight/mesh/instances.h>

#include <Imath/ImathMatrix.h>

#include <array>
#include <cstdint>

namespace vmlight {

struct SceneFrame;

enum class InstanceMode
{
    many, ///< instances where that saves much memory; few small copies are triangles of their own, which trace faster
    all, ///< wherever Embree's floats allow
    none ///< all triangles on their own
};

/// What became of the places of a scene's meshes.
struct InstanceCounts
{
    int64_t distinct = 0; ///< meshes that are instanced
    int64_t instances = 0; ///< places that Embree has as instances
    int64_t copies = 0; ///< places that are triangles of their own
    int64_t triangles = 0; ///< that rays can meet in instances
};

/// From the frame of a distinct mesh to the scene, as Embree is given it: the images of the axes, and of the origin.
struct InstanceTransform
{
    std::array<Imath::V3f, 4> columns;

    /// In double, of the same floats.
    Imath::V3d at(const Imath::V3f& p) const
    {
        return Imath::V3d(columns[0]) * p.x + Imath::V3d(columns[1]) * p.y + Imath::V3d(columns[2]) * p.z
            + Imath::V3d(columns[3]);
    }
    /// A normal that is as long as twice its triangle's area, of the triangle there; a mirror keeps the outside out.
    Imath::V3d normal_at(const Imath::V3f& normal) const;
};

/// The transform of a place, whose mesh is traced in `local`, in a scene in `frame`.
///
/// Embree takes rays to the mesh in floats. That moves them by some roundings of coordinates, times how unevenly the
/// transform scales, times the larger of mesh and scene.
///
/// @returns false if that may be more than rays start off the surface, or its inverse may leave the floats: the place
///          must be triangles of its own, whose vertices are rounded once
bool instance_transform(InstanceTransform& dst, const Imath::M44d& to_object, const SceneFrame& local,
                        const SceneFrame& frame);

/// Whether places are worth to be instances: not if all of them together have so few triangles.
bool are_many(const MeshInstances& instances);

} // namespace vmlight
