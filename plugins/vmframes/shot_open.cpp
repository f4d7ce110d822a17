// SPDX-License-Identifier: Apache-2.0
// What a shot takes in: light, objects, ground, background, and where the camera stands.
#include "shot.h"

#include <vmlight/base/format.h>
#include <vmlight/base/params.h>
#include <vmlight/frame/ground.h>
#include <vmlight/frame/surface_color.h>
#include <vmlight/lightmap/model.h>

#include <algorithm>

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

} // namespace vmlight::frames
