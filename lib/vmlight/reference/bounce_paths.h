// SPDX-License-Identifier: Apache-2.0
/// Paths with one bounce: an estimate, for each ray of the reference, of the light that what it meets sends back.
#pragma once

#include <vmlight/lightmap/environment_light.h>
#include <vmlight/math/rotation.h>
#include <vmlight/reference/random.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/trace/ground_plane.h>
#include <vmlight/trace/surface.h>

#include <Imath/ImathVec.h>

#include <array>

namespace vmlight {

/// One per thread.
class BouncePaths
{
public:
    /// @param scene, light     must outlive this
    /// @param length   of rays, in scene units
    BouncePaths(const BakeScene& scene, const GroundPlane& ground, const EnvironmentLight& light,
                const Rotation& to_environment, float length, double albedo)
        : m_scene(scene)
        , m_ground(ground)
        , m_light(light)
        , m_to_environment(to_environment)
        , m_to_object(to_environment.transposed())
        , m_length(length)
        , m_albedo(albedo)
        , m_surface(scene.mesh(), scene.frame())
    {
    }

    /// Follow the ray from `point` along `direction`, of the density cosine / pi, and add what it brings to `dst`, by
    /// the next flush() at the latest. Directions below the surface bring nothing. All rays until flush() are of one
    /// point.
    void add(const SurfacePoint& point, const Imath::V3d& direction, Imath::V3d& dst, ReferenceRandom& random);
    void flush(const SurfacePoint& point, ReferenceRandom& random);

private:
    using Points = std::array<SurfacePoint, kPacketSize>;
    // Add to what waits in `owners` the light of the sky that one pair of rays brings to each of `points`.
    void light(const Points& points, const std::array<Imath::V3d*, kPacketSize>& owners, int count,
               ReferenceRandom& random);
    // Set `dst` to what a ray met, on the side that it met. False if that has no area, and so sends no light.
    bool meet(SurfacePoint& dst, const SurfacePoint& from, const Imath::V3f& direction, const NearestHit& hit);

    const BakeScene& m_scene;
    const GroundPlane m_ground;
    const EnvironmentLight& m_light;
    const Rotation m_to_environment, m_to_object;
    const float m_length;
    const double m_albedo;
    Surface m_surface;
    int m_waiting = 0;
    std::array<Imath::V3f, kPacketSize> m_directions;
    std::array<Imath::V3d*, kPacketSize> m_owners {};
};

} // namespace vmlight
