// SPDX-License-Identifier: Apache-2.0
#include "shot.h"

#include <vmlight/base/format.h>
#include <vmlight/base/frames.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/frame/ground.h>
#include <vmlight/image/color.h>
#include <vmlight/lightmap/light_level.h>

#include <algorithm>

namespace vmlight::frames {
namespace {

// Position, right, up and back in the space of the mesh, and half the height of the picture.
std::string camera_text(const Camera& camera)
{
    const auto text = [](const Imath::V3d& v) { return format("({}, {}, {})", v.x, v.y, v.z); };
    return format("({}, {}, {}, {}, {})", text(camera.position), text(camera.right), text(camera.up),
                  text(-camera.forward), camera.half_height);
}

} // namespace

Camera Shot::camera_at(size_t index) const
{
    return camera_for(m_request.turn.turntable ? turned(m_camera, turn_at(index), m_subject.centre()) : m_camera,
                      m_pose);
}

// The objects turn about y after their own rotation, the environment after its own.
LightmapParams Shot::light_at(size_t index) const
{
    const double object = m_request.turn.turntable ? turn_at(index) : 0;
    const double environment = m_request.turn.turn_environment ? turn_at(index) : 0;
    // E^-1 R of the turns goes between the environment's own rotation and the object's.
    return turned_light(m_request.light, m_pose, object - environment);
}

bool Shot::light_all(size_t index, const std::string& model, const MakeOptions& options, std::string& error)
{
    if (m_lit_index == index && m_lit_model == model)
        return true;
    if (m_open_index != index && m_request.moves() && !open_frame(index, options, error))
        return false;
    const std::string& texture = m_request.object.texture;
    if (texture.find('#') != std::string::npos) {
        if (!m_objects[0]->show_texture(frame_path(texture, m_request.frames[index]), options, error))
            return false;
        m_scene.surfaces[0] = m_objects[0]->surface();
    }
    m_lit_index = index;
    m_lit_model = model;
    if (m_request.environment.empty())
        return true;
    LightmapParams params = light_at(index);
    params.model = "auto"; // the rotation is that of every model
    if (!lightmap_rotation(m_scene.background.rotation, params, error))
        return false;
    params.model = model;
    const std::vector<std::string>& layers = m_request.render.layers;
    const bool shows_visibility
        = std::any_of(frame_layers().begin(), frame_layers().end(), [&](const FrameLayer& layer) {
              return layer.needs_visibility && std::find(layers.begin(), layers.end(), layer.name) != layers.end();
          });
    size_t i = 0;
    std::vector<FrameObject*> all;
    for (const auto& object : m_objects)
        all.push_back(object.get());
    if (m_ground)
        all.push_back(m_ground.get());
    for (FrameObject* object : all) {
        if (!object->light(m_light, params, m_request.reference, options, error,
                           object == all[0] ? &m_used_model : nullptr))
            return false;
        FrameSurface& surface = m_scene.surfaces[i++];
        const bool is_mirror = m_cones && object->surface().strands;
        if ((shows_visibility || is_mirror) && !object->surface().visibility)
            object->show_visibility(options.threads);
        if (is_mirror)
            object->surface().specular = std::make_shared<StrandSpecular>(
                StrandSpecular { m_cones, m_scene.background.rotation, m_request.specular.strand_specular });
        if (object->surface().catches_shadows
            && !find_unshadowed(object->surface().unshadowed, object->mesh(), m_light, params, error))
            return false;
        surface = object->surface();
    }
    return true;
}

bool Shot::render_at(OIIO::ImageBuf& dst, size_t index, const RenderParams& params, const MakeOptions& options,
                     std::string& error)
{
    return render_frame(dst, m_scene, camera_at(index), params, options.threads,
                        options.step("render", params.size.width, params.size.height), error);
}

bool Shot::render(OIIO::ImageBuf& dst, size_t index, const std::string& model, const RenderParams& params,
                  const MakeOptions& options, std::string& error)
{
    if (!light_all(index, model, options, error))
        return false;
    const Stopwatch timer;
    if (!render_at(dst, index, params, options, error))
        return false;
    m_render_seconds += timer();
    if (m_light.space.empty())
        dst.specmod().attribute("colorInteropID", "unknown");
    else
        tag_scene_linear(dst.specmod(), m_light.space);
    dst.specmod().attribute("vmlight:model", m_used_model);
    dst.specmod().attribute("vmlight:camera", camera_text(camera_at(index)));
    return true;
}

double Shot::light_seconds() const
{
    double seconds = m_past_light_seconds + (m_ground ? m_ground->light_seconds() : 0);
    for (const auto& object : m_objects)
        seconds += object->light_seconds();
    return seconds;
}

bool Shot::measure(double& mean, size_t index, const std::string& model, const MakeOptions& options, std::string& error)
{
    RenderParams small = m_request.render;
    small.size = { std::max(1, small.size.width / 4), std::max(1, small.size.height / 4) };
    small.spp = 1;
    small.layers.clear();
    OIIO::ImageBuf image;
    const bool is_visible = m_scene.background.is_visible;
    const bool lit = light_all(index, model, options, error);
    m_scene.background.is_visible = false;
    if (m_ground)
        m_scene.surfaces.back().opacity = 0;
    const bool rendered = lit && render_at(image, index, small, options, error);
    m_scene.background.is_visible = is_visible;
    if (m_ground)
        m_scene.surfaces.back().opacity = 1;
    if (!rendered)
        return false;
    mean = covered_luminance(image, m_light.space);
    return true;
}

} // namespace vmlight::frames
