// SPDX-License-Identifier: Apache-2.0
#include "shot.h"

#include <vmlight/base/format.h>
#include <vmlight/base/frames.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/frame/ground.h>
#include <vmlight/frame/surface_color.h>
#include <vmlight/image/color.h>
#include <vmlight/lightmap/light_level.h>
#include <vmlight/lightmap/model.h>
#include <vmlight/math/rotation.h>

#include <algorithm>
#include <array>

namespace vmlight::frames {
namespace {

// Maps of the ground have room for soft shadows only.
constexpr int kGroundTexels = 512;

bool needs_stack(const std::vector<std::string>& models)
{
    return std::any_of(models.begin(), models.end(), [](const std::string& model) {
        const ModelEntry* entry = find_model_entry(model);
        return model == "auto" || (entry && entry->light != ModelLight::cfem);
    });
}

Imath::C3f color_of(const std::vector<double>& rgb)
{
    return rgb.empty() ? Imath::C3f(1, 1, 1) : Imath::C3f(float(rgb[0]), float(rgb[1]), float(rgb[2]));
}

// Position, right, up and back in the space of the mesh, and half the height of the picture.
std::string camera_text(const Camera& camera)
{
    const auto text = [](const Imath::V3d& v) { return format("({}, {}, {})", v.x, v.y, v.z); };
    return format("({}, {}, {}, {}, {})", text(camera.position), text(camera.right), text(camera.up),
                  text(-camera.forward), camera.half_height);
}

} // namespace

bool Shot::open_light(const MakeOptions& options, std::string& error)
{
    if (m_request.environment.empty())
        return true;
    const std::vector<std::string> models = m_request.models();
    CfemRecipe filter = m_request.filter;
    filter.stack = needs_stack(models) || has_strands(m_request.at(0));
    filter.suns = m_trace.suns == "off" ? "off" : "auto";
    const bool is_traced = std::find(models.begin(), models.end(), kReferenceModel) != models.end();
    const bool is_seen = m_request.stage.background == "environment";
    const bool is_mirrored = m_request.specular.strand_specular > 0;
    if (!m_light.open(m_request.environment, filter, is_traced || is_seen || is_mirrored, options, error))
        return false;
    if ((is_traced || is_seen) && !m_light.environment.initialized()) {
        error = format("\"{}\": {} needs the environment itself, and this is only its filtered map",
                       m_request.environment, is_traced ? "the model reference" : "--background environment");
        return false;
    }
    return !is_mirrored || filter_for_specular(m_cones, m_light, m_request.specular, options.threads, error);
}

bool Shot::open_objects(size_t index, const MakeOptions& options, std::string& error)
{
    const Request now = m_request.at(index);
    std::vector<ObjectRecipe> recipes { now.object };
    Subject subject;
    m_objects.clear();
    for (const std::string& path : now.stage.object) {
        ObjectRecipe recipe;
        recipe.map = now.object.map;
        recipe.map.selection = {};
        recipe.map.mesh = path;
        recipes.push_back(recipe);
    }
    for (ObjectRecipe& recipe : recipes) {
        recipe.trace = m_trace;
        if (m_request.stage.white) // as materials are left out
            recipe.map.cutout_params.cutouts = "off";
        m_objects.push_back(make_frame_object(recipe));
        if (!m_objects.back()->open(recipe, options, error))
            return false;
        FrameSurface& surface = m_objects.back()->surface();
        if (surface.strands && !m_request.stage.white)
            surface.strand_color = color_of(m_request.stage.strand_color);
        subject.add(m_objects.back()->mesh(), m_pose);
        if (!m_request.stage.white
            && !m_objects.back()->read_materials(m_light.space, m_request.filter.colorconfig, options, error))
            return false;
    }
    if (subject.is_empty()) {
        error = format("\"{}\": nothing in it can be seen", now.object.map.mesh);
        return false;
    }
    if (m_subject.is_empty()) // the camera and the ground stay where the first frame has them
        m_subject = subject;
    return true;
}

bool Shot::open_ground(const MakeOptions& options, std::string& error)
{
    const std::string& ground = m_request.stage.ground;
    if (ground == "none")
        return true;
    if (m_request.environment.empty()) {
        error = "--ground needs an environment to light it";
        return false;
    }
    const bool has_texture = ground != "white" && ground != "shadow";
    VismapParams params = m_request.object.map.vismap_params;
    params.resolution = { kGroundTexels, kGroundTexels };
    params.width = params.height = 0;
    m_ground = std::make_unique<LitObject>();
    m_ground->open(make_ground_mesh(m_subject, m_pose, has_texture ? ground : ""), params, m_trace);
    m_ground->surface().catches_shadows = ground == "shadow";
    fade_out(m_ground->surface());
    return !has_texture || m_ground->read_materials(m_light.space, m_request.filter.colorconfig, options, error);
}

bool Shot::open_background(const MakeOptions& options, std::string& error)
{
    const std::string& background = m_request.stage.background;
    if (background == "none")
        return true;
    m_scene.background.is_visible = true;
    if (background == "environment")
        return make_background(m_scene.background.environment, m_light.environment, m_request.stage.background_blur,
                               options.threads, error);
    std::vector<double> color;
    parse_value(color, background, Numbers { 3 }, error); // main() has checked it
    m_scene.background.color = color_of(color);
    return true;
}

bool Shot::place(std::string& error)
{
    const Size& size = m_request.render.size;
    const double aspect = double(size.width) / size.height;
    if (m_request.camera.camera.empty())
        m_camera = place_camera(m_request.camera, m_subject, aspect, m_request.turn.turntable);
    else if (!find_camera(m_camera, m_request.camera, m_objects[0]->mesh(), aspect, error))
        return false;
    return true;
}

Camera Shot::camera_at(size_t index) const
{
    return camera_for(m_request.turn.turntable ? turned(m_camera, turn_at(index), m_subject.centre()) : m_camera,
                      m_pose);
}

// The model reference takes it for every surface.
void Shot::warn_of_unused(const MakeOptions& options) const
{
    const BounceParams &given = m_trace.bounce, defaults;
    const std::vector<std::string> models = m_request.models();
    if (given.bounce != "off" && given.bounce_albedo != defaults.bounce_albedo
        && std::find(models.begin(), models.end(), kReferenceModel) == models.end()
        && std::all_of(m_scene.surfaces.begin(), m_scene.surfaces.end(), has_all_colors))
        options.report_warning("bounce_albedo changes nothing: every material has a colour");
}

bool Shot::open(const MakeOptions& options, std::string& error)
{
    if (!object_pose(m_pose, m_request.light, error))
        return false;
    m_trace = m_request.object.trace;
    // Before the environment is split into suns and the rest: all objects are lit by one or the other.
    if (!choose_trace(m_trace, m_request.at(0).object.vismap, options, error) || !open_light(options, error)
        || !open_frame(0, options, error) || !open_background(options, error))
        return false;
    warn_of_unused(options);
    return true;
}

// All of them anew, if one is: each is in the others' way.
bool Shot::open_frame(size_t index, const MakeOptions& options, std::string& error)
{
    m_past_light_seconds = light_seconds();
    m_scene.surfaces.clear();
    if (!open_objects(index, options, error) || !open_ground(options, error) || !place(error))
        return false;
    m_open_index = index;
    for (const auto& object : m_objects)
        m_scene.surfaces.push_back(object->surface());
    if (m_ground)
        m_scene.surfaces.push_back(m_ground->surface());
    for (size_t i = 0; i < m_scene.surfaces.size(); ++i) {
        std::vector<FrameSurface> others = m_scene.surfaces;
        others.erase(others.begin() + std::ptrdiff_t(i));
        (i < m_objects.size() ? *m_objects[i] : *m_ground).set_occluders(std::move(others));
    }
    return m_scene.build(options.threads, error);
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
        if (!m_objects[0]->show_texture(frame_path(texture, m_request.frames[index]), error))
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
        if (!object->light(m_light, params, m_request.reference, options, error, &m_used_model))
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
