// SPDX-License-Identifier: Apache-2.0
#include "view_state.h"

#include <algorithm>
#include <cmath>

namespace vmlight::view {
namespace {

constexpr double kDegreesPerPixel = 0.5;

// In [-180, 180), so that flags take it.
double wrapped_degrees(double degrees)
{
    return degrees - 360 * std::floor((degrees + 180) / 360);
}

} // namespace

ViewState state_of(const Request& request)
{
    ViewState state;
    state.light = request.light;
    state.trace = request.trace;
    state.camera = request.camera;
    state.has_background = request.view.background == "environment";
    state.is_white = request.view.white;
    state.show = request.view.show;
    state.display = { request.display.display, request.display.view, request.display.look };
    return state;
}

Camera camera_of(const ViewState& state, const Mesh& mesh, const Subject& subject, double aspect)
{
    LightmapParams own = state.light;
    own.env_rotate.clear();
    Rotation pose;
    std::string ignored; // parsed where it was given
    lightmap_rotation(pose, own, ignored);
    const double radius = std::max(subject.radius(), 1e-30);
    Camera camera;
    CameraParams params = state.camera;
    if (params.camera.empty() || !find_camera(camera, params, mesh, aspect, ignored)) {
        Imath::V3d target = subject.centre();
        if (!params.look_at.empty())
            target = Imath::V3d(params.look_at[0], params.look_at[1], params.look_at[2]);
        params.look_at = { target.x, target.y, target.z };
        camera = place_camera(params, Subject(), aspect, false); // its axes and angles; the place follows
        target += (camera.right * state.pan.x + camera.up * state.pan.y) * radius;
        // Around a ball, so that neither turning nor tilting moves the object nearer.
        const double size = radius / (params.fill * std::min(1.0, aspect));
        double distance = 2 * radius + size;
        if (camera.is_orthographic) {
            camera.half_height = size;
            camera.half_width = size * aspect;
        } else {
            distance = size / camera.half_height;
        }
        camera.position = target - camera.forward * distance;
    }
    return camera_for(turned(camera, state.turn, subject.centre()), pose);
}

void turn_object(ViewState& state, double dx, double dy)
{
    state.camera.camera.clear();
    state.turn = wrapped_degrees(state.turn + kDegreesPerPixel * dx);
    state.camera.elevation = std::clamp(state.camera.elevation + kDegreesPerPixel * dy, -90.0, 90.0);
}

void turn_environment(ViewState& state, double dx)
{
    std::vector<double>& angles = state.light.env_rotate;
    angles.resize(3, 0.0);
    angles[1] = wrapped_degrees(angles[1] + kDegreesPerPixel * dx);
}

void turn_camera(ViewState& state, double dx, double dy)
{
    state.camera.camera.clear();
    state.camera.azimuth = wrapped_degrees(state.camera.azimuth - kDegreesPerPixel * dx);
    state.camera.elevation = std::clamp(state.camera.elevation + kDegreesPerPixel * dy, -90.0, 90.0);
}

void pan_camera(ViewState& state, double dx, double dy, int height)
{
    state.camera.camera.clear();
    const double step = 2 / (state.camera.fill * std::max(1, height));
    state.pan += Imath::V2d(-dx, dy) * step;
}

void zoom(ViewState& state, double steps)
{
    state.camera.camera.clear();
    state.camera.fill = std::clamp(state.camera.fill * std::pow(1.15, steps), 0.01, 100.0);
}

} // namespace vmlight::view
