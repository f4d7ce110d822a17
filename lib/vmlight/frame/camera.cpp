// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/camera.h>

#include <vmlight/base/format.h>
#include <vmlight/mesh/strands.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace vmlight {
namespace {

using Imath::V3d;

constexpr double kRadians = 3.14159265358979323846 / 180;
// Heights and angles of a turning subject's outline.
constexpr int kHeights = 64, kAngles = 64;

} // namespace

CameraRay Camera::ray(double x, double y, int width, int height) const
{
    const V3d across = right * (2 * half_width / width), down = -up * (2 * half_height / height);
    const V3d offset = across * (x - 0.5 * width) + down * (y - 0.5 * height);
    CameraRay ray;
    ray.origin = is_orthographic ? position + offset : position;
    ray.direction = is_orthographic ? forward : forward + offset;
    (is_orthographic ? ray.origin_dx : ray.direction_dx) = across;
    (is_orthographic ? ray.origin_dy : ray.direction_dy) = down;
    return ray;
}

void Subject::add(const Mesh& mesh, const Rotation& pose)
{
    std::vector<bool> used(mesh.positions.size());
    for (const auto& triangle : mesh.triangles)
        for (const uint32_t vertex : triangle)
            used[vertex] = true;
    for (size_t v = 0; v < used.size(); ++v) {
        if (!used[v])
            continue;
        add(rotate(pose, mesh.positions[v]));
    }
    if (mesh.strands)
        for (const V3d& point : mesh.strands->points)
            add(rotate(pose, point));
}

void Subject::add(const V3d& p)
{
    for (int axis = 0; axis < 3; ++axis) {
        m_low[axis] = std::min(m_low[axis], p[axis]);
        m_high[axis] = std::max(m_high[axis], p[axis]);
    }
    m_points.push_back(p);
}

// Points whose hull holds the subject in every position of a turn: at some heights, the outermost circle. Its corners
// are where they are as seen from the camera, so that all cameras of one height are equally far.
void Subject::rings(std::vector<V3d>& dst, double azimuth) const
{
    std::array<double, kHeights> radius {};
    const V3d middle = centre();
    const double step = (m_high.y - m_low.y) / kHeights;
    for (const V3d& p : m_points) {
        const int bin = step > 0 ? std::min(int((p.y - m_low.y) / step), kHeights - 1) : 0;
        radius[bin] = std::max(radius[bin], std::hypot(p.x - middle.x, p.z - middle.z));
    }
    const double outside = 1 / std::cos(kRadians * 180 / kAngles); // polygons around the circles
    for (int bin = 0; bin < kHeights; ++bin)
        for (int end = 0; end < 2 && radius[bin] > 0; ++end)
            for (int k = 0; k < kAngles; ++k) {
                const double angle = 2 * kRadians * 180 * k / kAngles + azimuth * kRadians, r = radius[bin] * outside;
                dst.emplace_back(middle.x + r * std::sin(angle), m_low.y + (bin + end) * step,
                                 middle.z + r * std::cos(angle));
            }
}

Camera place_camera(const CameraParams& params, const Subject& subject, double aspect, bool turns)
{
    Camera camera;
    // Multiples of 90 degrees are exact.
    const Rotation turn = rotation_from_angles(-params.elevation, 0, 0);
    const Rotation around = rotation_from_angles(0, params.azimuth, 0);
    const auto place = [&](const V3d& axis) { return rotate(around, rotate(turn, axis)); };
    camera.right = place({ 1, 0, 0 });
    camera.up = place({ 0, 1, 0 });
    camera.forward = place({ 0, 0, -1 });
    camera.is_orthographic = params.fov == 0;

    V3d target = subject.centre();
    if (!params.look_at.empty())
        target = V3d(params.look_at[0], params.look_at[1], params.look_at[2]);
    std::vector<V3d> outline;
    if (turns)
        subject.rings(outline, params.azimuth);
    const std::vector<V3d>& points = turns ? outline : subject.m_points;

    const double tangent = std::tan(0.5 * params.fov * kRadians);
    double size = 0, distance = 0, nearest = 0;
    for (const V3d& p : points) {
        const V3d q = p - target;
        // The half height that this point asks for.
        const double need = std::max(std::abs(q.dot(camera.up)), std::abs(q.dot(camera.right)) / aspect) / params.fill;
        const double depth = q.dot(camera.forward);
        size = std::max(size, need);
        distance = std::max(distance, camera.is_orthographic ? 0 : need / tangent - depth);
        nearest = std::max(nearest, -depth);
    }
    if (size == 0)
        size = 1; // one point, or nothing at all
    if (camera.is_orthographic) {
        camera.half_height = size;
        distance = 2 * nearest + size;
    } else {
        camera.half_height = tangent;
        // What is cropped may reach up to the camera, but not behind it.
        distance = std::max(distance, nearest + 1e-3 * size);
        if (distance == 0)
            distance = size / tangent;
    }
    camera.half_width = camera.half_height * aspect;
    camera.position = target - camera.forward * distance;
    return camera;
}

bool find_camera(Camera& dst, const CameraParams& params, const Mesh& mesh, double aspect, std::string& error)
{
    std::string names;
    for (const MeshCamera& candidate : mesh.cameras) {
        if (candidate.name != params.camera && candidate.node != params.camera) {
            names += (names.empty() ? "\"" : ", \"") + candidate.name + "\"";
            continue;
        }
        dst.position = candidate.position;
        dst.right = candidate.right;
        dst.up = candidate.up;
        dst.forward = candidate.forward;
        dst.is_orthographic = candidate.is_orthographic;
        dst.half_height = candidate.half_height;
        const double own = candidate.aspect > 0 ? candidate.aspect : aspect;
        if (own > aspect)
            dst.half_height *= own / aspect;
        dst.half_width = dst.half_height * aspect;
        return true;
    }
    error = format("\"{}\" has no camera \"{}\"; it has {}", mesh.path, params.camera, names.empty() ? "none" : names);
    return false;
}

Camera camera_for(const Camera& camera, const Rotation& pose)
{
    const Rotation back = pose.transposed();
    Camera result = camera;
    for (V3d Camera::*vector : { &Camera::position, &Camera::right, &Camera::up, &Camera::forward })
        result.*vector = rotate(back, camera.*vector);
    return result;
}

Camera turned(const Camera& camera, double degrees, const V3d& centre)
{
    const Rotation back = rotation_from_angles(0, -degrees, 0);
    Camera result = camera;
    result.position = centre + rotate(back, camera.position - centre);
    for (V3d Camera::*axis : { &Camera::right, &Camera::up, &Camera::forward })
        result.*axis = rotate(back, camera.*axis);
    return result;
}

std::string unused_reason(const CameraParams& params, const std::string& name)
{
    const std::vector<std::string> names = param_names(params);
    const bool is_placed = name != "camera" && std::find(names.begin(), names.end(), name) != names.end();
    return is_placed && !params.camera.empty() ? "the camera of the file has its own place and lens" : "";
}

} // namespace vmlight
