// SPDX-License-Identifier: Apache-2.0
/// What the user of the window has chosen to see.
#pragma once

#include "../display/display_config.h"
#include "../request.h"

#include <Imath/ImathVec.h>

#include <string>

namespace vmlight::view {

struct ViewState
{
    /// The object's own rotation, the environment's, the model and the exposure in stops.
    LightmapParams light;
    /// What of the light is traced besides.
    TraceParams trace;
    /// Degrees that the object is turned about y, after its own rotation.
    double turn = 0;
    CameraParams camera;
    /// What the camera looks at, from the object's middle, in half diagonals of its box: to the right and up.
    Imath::V2d pan { 0 };
    bool has_background = false;
    bool is_white = false;
    /// A word of ViewParams::show.
    std::string show = "lit";
    /// The model to the right of the line, kReferenceModel among them; "" for no line.
    std::string second;
    double wipe = 0.5; ///< where the line is, as a share of the width
    DisplayChoice display;
};

/// The state that a request asks for.
ViewState state_of(const Request& request);

/// The camera in the space of the object, which turns in it: at one distance for every turn and tilt, or that of the
/// mesh's own camera if the state names one.
Camera camera_of(const ViewState& state, const Mesh& mesh, const Subject& subject, double aspect);

// What the mouse does, in pixels of movement.
void turn_object(ViewState& state, double dx, double dy);
void turn_environment(ViewState& state, double dx);
void turn_camera(ViewState& state, double dx, double dy);
void pan_camera(ViewState& state, double dx, double dy, int height);
void zoom(ViewState& state, double steps);

} // namespace vmlight::view
