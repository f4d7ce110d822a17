// SPDX-License-Identifier: Apache-2.0
/// Cameras of frames, and how they are placed: around the object, or as the mesh file has them.
#pragma once

#include <vmlight/base/params.h>
#include <vmlight/math/rotation.h>
#include <vmlight/mesh/mesh.h>

#include <Imath/ImathVec.h>

#include <string>
#include <vector>

namespace vmlight {

/// A ray through a point of the picture, and how it changes from pixel to pixel. `direction` is not of unit length: it
/// has length 1 along the camera's forward axis, so that ray parameters are depths.
struct CameraRay
{
    Imath::V3d origin, direction;
    Imath::V3d origin_dx { 0 }, origin_dy { 0 }, direction_dx { 0 }, direction_dy { 0 };

    void scale_differentials(double factor)
    {
        origin_dx *= factor;
        origin_dy *= factor;
        direction_dx *= factor;
        direction_dy *= factor;
    }
};

/// A pinhole or orthographic camera in object space. Its axes are of unit length and orthogonal.
struct Camera
{
    Imath::V3d position { 0, 0, 1 }, right { 1, 0, 0 }, up { 0, 1, 0 }, forward { 0, 0, -1 };
    /// Half the width and height of what the picture shows: at depth 1 in perspective, anywhere if orthographic.
    double half_width = 0.5, half_height = 0.5;
    bool is_orthographic = false;

    /// The ray through (x, y) of a picture of `width` x `height` pixels; (0, 0) is its upper left corner, pixel centres
    /// are at 0.5.
    CameraRay ray(double x, double y, int width, int height) const;
};

struct CameraParams
{
    /// Where the camera stands around the object, in degrees: 0 is on +z, which faces the front of a glTF, 90 on +x.
    double azimuth = 0;
    double elevation = 10;
    /// Vertical field of view in degrees; 0 is an orthographic camera.
    double fov = 30;
    /// How much of the picture the object fills: 1 touches the border.
    double fill = 0.9;
    /// What the camera looks at, in mesh units; empty for the object's middle.
    std::vector<double> look_at;
    /// A camera of the mesh file, by name; it replaces all of the above. "" for none.
    std::string camera;

    template <class Visit> void visit(Visit&& field)
    {
        field("azimuth", azimuth, Range { -360, 360 },
              "Camera position around the object, in degrees: 0 is +z, 90 is +x");
        field("elevation", elevation, Range { -90, 90 }, "Camera height, in degrees above the horizon");
        field("fov", fov, Range { 0, 170 }, "Vertical field of view in degrees; 0: orthographic");
        field("fill", fill, Range { 0.01, 100 },
              advanced("Share of the picture that the object fills; above 1 crops it"));
        field("look_at", look_at, Numbers { 3 },
              advanced("Point to look at: x,y,z in mesh units; default: the object's middle"));
        field("camera", camera, Text { "NAME" }, "Use this camera of the mesh file instead");
    }
};

/// What the picture is of, as far as the camera must know it.
class Subject
{
public:
    /// Add the vertices that triangles of `mesh` use, and the points of its strands, turned by `pose`.
    void add(const Mesh& mesh, const Rotation& pose = {});

    bool is_empty() const { return !(m_low.x <= m_high.x); }
    Imath::V3d centre() const { return (m_low + m_high) * 0.5; }
    const Imath::V3d& low() const { return m_low; }
    const Imath::V3d& high() const { return m_high; }
    /// Half the diagonal of the bounding box.
    double radius() const { return (m_high - m_low).length() * 0.5; }

private:
    void add(const Imath::V3d& p);
    friend Camera place_camera(const CameraParams&, const Subject&, double, bool);
    void rings(std::vector<Imath::V3d>& dst, double azimuth) const;

    Imath::V3d m_low { HUGE_VAL }, m_high { -HUGE_VAL };
    std::vector<Imath::V3d> m_points;
};

/// Place the camera by all parameters but `camera`, at the least distance from which all of the subject is in the
/// picture.
///
/// @param aspect   width of the picture over its height
/// @param turns    the subject turns about its vertical axis: it fits in every position, at one distance
Camera place_camera(const CameraParams& params, const Subject& subject, double aspect, bool turns);

/// The camera called `params.camera` of `mesh`, or that of a node of this name. Where the picture has another aspect
/// ratio than the camera, all that the camera shows is in it. False, with the reason in `error`, if there is none; the
/// error lists the names.
bool find_camera(Camera& dst, const CameraParams& params, const Mesh& mesh, double aspect, std::string& error);

/// The camera in the space of an object that `pose` has turned about the origin.
Camera camera_for(const Camera& camera, const Rotation& pose);

/// The camera after the subject has turned by `degrees` about the vertical axis through `centre`, counter-clockwise
/// seen from above, in the subject's own space: it goes around the other way.
Camera turned(const Camera& camera, double degrees, const Imath::V3d& centre);

/// Why no value of the parameter `name` can change where the camera is, given the others, or "".
std::string unused_reason(const CameraParams& params, const std::string& name);

} // namespace vmlight
