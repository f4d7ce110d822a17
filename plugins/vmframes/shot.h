// SPDX-License-Identifier: Apache-2.0
/// The scene that vmframes renders: objects, ground, light and camera, and how they change over the frames.
#pragma once

#include "request.h"

#include <vmlight/frame/frame_object.h>
#include <vmlight/frame/frame_scene.h>
#include <vmlight/frame/lit_object.h>
#include <vmlight/frame/scene_light.h>
#include <vmlight/stage/make_options.h>

#include <OpenImageIO/imagebuf.h>

#include <memory>
#include <string>
#include <vector>

namespace vmlight::frames {

class Shot
{
public:
    explicit Shot(const Request& request)
        : m_request(request)
    {
    }

    /// Read all inputs, and bake what is missing. False, with the reason in `error`, on failure.
    bool open(const MakeOptions& options, std::string& error);

    /// Render frame number `index` by a model: see render_frame(). Scene-linear, without exposure.
    bool render(OIIO::ImageBuf& dst, size_t index, const std::string& model, const RenderParams& params,
                const MakeOptions& options, std::string& error);

    /// The mean luminance of what covers frame number `index`, the background left out; 0 if nothing does. Renders it
    /// small.
    bool measure(double& mean, size_t index, const std::string& model, const MakeOptions& options, std::string& error);

    /// The model that lit the first object: of `auto`, the one that was chosen.
    const std::string& used_model() const { return m_used_model; }

    /// Seconds spent so far: lighting objects and ground, without baking, and in render().
    double light_seconds() const;
    double render_seconds() const { return m_render_seconds; }

    /// Interop id of the space of the light.
    const std::string& space() const { return m_light.space; }
    /// nullptr without.
    const LitObject* ground() const { return m_ground.get(); }
    /// The objects, without the ground.
    const std::vector<std::unique_ptr<FrameObject>>& objects() const { return m_objects; }

private:
    bool open_light(const MakeOptions& options, std::string& error);
    bool open_frame(size_t index, const MakeOptions& options, std::string& error);
    bool open_objects(size_t index, const MakeOptions& options, std::string& error);
    bool open_ground(const MakeOptions& options, std::string& error);
    bool open_background(const MakeOptions& options, std::string& error);
    void warn_of_unused(const MakeOptions& options) const;
    bool place(std::string& error);
    Camera camera_at(size_t index) const;
    bool light_all(size_t index, const std::string& model, const MakeOptions& options, std::string& error);
    bool render_at(OIIO::ImageBuf& dst, size_t index, const RenderParams& params, const MakeOptions& options,
                   std::string& error);
    double turn_at(size_t index) const { return 360.0 * double(index) / double(m_request.frames.size()); }
    LightmapParams light_at(size_t index) const;

    const Request& m_request;
    TraceParams m_trace; // the request's, or what of it can be
    SceneLight m_light;
    std::shared_ptr<const ConeLevels> m_cones; // of strands with highlights
    std::vector<std::unique_ptr<FrameObject>> m_objects;
    std::unique_ptr<LitObject> m_ground;
    // The objects' own rotation in the world, where the camera stands and the ground is level. All else is in the
    // objects' space.
    Rotation m_pose;
    Subject m_subject;
    Camera m_camera;
    FrameScene m_scene;
    // What the objects are lit with now: a frame is lit once for all that is rendered of it.
    size_t m_lit_index = ~size_t(0);
    std::string m_lit_model, m_used_model;
    size_t m_open_index = 0; ///< of the objects
    double m_past_light_seconds = 0; ///< of objects of earlier frames
    double m_render_seconds = 0;
};

} // namespace vmlight::frames
