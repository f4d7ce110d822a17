// SPDX-License-Identifier: Apache-2.0
/// make_vismap() and make_reference(): what traces rays.
#include "function.h"
#include "image.h"
#include "mesh_input.h"
#include "recipe_input.h"
#include "stages.h"
#include "work.h"

#include <vmlight/base/oiio_compat.h>
#include <vmlight/reference/reference.h>
#include <vmlight/stage/environment_file.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/stage/scene_cache.h>
#include <vmlight/trace/bake_scene.h>

#include <algorithm>

namespace vmlight::python {
namespace {

const char* const kFileOnly = "a mesh that is a file";

const char* const kVismap
    = "Bake a visibility map: how much of its hemisphere each texel of a mesh sees, V, and in which mean direction, "
      "B.\n\n"
      "A mesh that is a file is baked as makevismap bakes it, to the same bytes. One in memory takes the arguments of "
      "the\nbake alone; what concerns files is refused.";
const char* const kVismapReturns
    = "channels visibility, direction.x, direction.y, direction.z, and those of channels and basis; float32";

Image bake_files(const Call& call, VismapRecipe recipe, const MeshInput& input)
{
    recipe.mesh = input.mesh_path;
    recipe.occluder = input.occluder_paths;
    check_recipe(recipe, call);
    OIIO::ImageBuf map;
    do_work(call.work, input.paths(), [&](const MakeOptions& options, std::string& error) {
        if (make_image(map, recipe, options))
            return true;
        error = oiio::error_line(map);
        return false;
    });
    return own_one(std::move(map));
}

Image bake_arrays(const Call& call, const VismapParams& params, const MeshInput& input)
{
    allow_only(call, param_names(VismapParams()), kFileOnly);
    VismapRecipe recipe;
    recipe.vismap_params = params;
    check_unused(recipe, call);
    OIIO::ImageBuf map;
    do_work(call.work, {}, [&](const MakeOptions& options, std::string& error) {
        const Progress progress = options.step("bake", params.size().width, params.size().height);
        if (make_vismap(map, *input.mesh, input.occluders, params, nullptr, options.threads, progress))
            return true;
        error = oiio::error_line(map);
        return false;
    });
    return own_one(std::move(map));
}

/// What a reference depends on: the scene, the texels, the light and the rays.
struct ReferenceArguments
{
    ReferenceParams rays;
    VismapRecipe scene;
    LightmapParams light;
    CfemRecipe environment;
    double bounce_albedo = 0;

    template <class Visit> void visit(Visit&& field)
    {
        const auto only = [&](std::initializer_list<const char*> names) {
            return [&field, names](const char* name, auto& value, const auto& allowed, const Help& help) {
                if (std::find_if(names.begin(), names.end(), [&](const char* one) { return std::string(one) == name; })
                    != names.end())
                    field(name, value, allowed, help);
            };
        };
        rays.visit(field);
        scene.vismap_params.visit(
            only({ "resolution", "width", "height", "udim", "max_distance", "ground", "ground_height" }));
        light.visit(only({ "rotate", "matrix", "quaternion", "env_rotate", "exposure" }));
        field("bounce_albedo", bounce_albedo, Range { 0, 1 },
              "Albedo of the mesh and its occluders: adds what they send to each other, once; 0: direct light only");
        scene.mesh_params.visit(field);
        scene.cutout_params.visit(field);
        environment.visit(only({ "colorspace", "colorconfig", "layer", "layout" }));
    }
};

const char* const kReference
    = "Trace the light of each texel: the truth that visibility maps approximate.\n\n"
      "(1/pi) Int L(R w) vis(w) max(0, n.w) dw by independent rays, unbiased, with its standard error.";

bool trace(OIIO::ImageBuf& dst, const MeshInput& input, const ReferenceArguments& given, const OIIO::ImageBuf& light,
           const MakeOptions& options, std::string& error)
{
    const VismapParams& map = given.scene.vismap_params;
    ReferenceParams params = given.rays;
    params.bounce_albedo = given.bounce_albedo;
    const Progress progress = options.step("trace", map.size().width, map.size().height);
    bool made = false;
    if (input.mesh) {
        made = make_reference(dst, *input.mesh, input.occluders, light, map, given.light, params, options.threads,
                              progress);
    } else {
        SceneStamps stamps;
        BakeScenePointer scene;
        std::string at;
        VismapRecipe recipe = given.scene;
        recipe.cull_occluders = params.bounce_albedo == 0;
        if (!stamp_scene(stamps, recipe, at, error)
            || !share_scene(scene, recipe, stamps, options.threads, nullptr, at, error, options.steps()))
            return false;
        made = make_reference(dst, *scene, light, map, given.light, params, options.threads, progress);
    }
    if (!made)
        error = oiio::error_line(dst);
    return made;
}

Image trace_reference(const Call& call, ReferenceArguments given)
{
    const MeshInput input = mesh_input(call.operands[0], call.operands[2]);
    if (input.mesh)
        for (const char* name :
             { "normals", "crease_angle", "uv_set", "up", "frame", "fps", "terrain", "height_scale", "cutouts" })
            if (call.has(name))
                throw py::type_error(std::string(name) + ": only for " + kFileOnly);
    given.scene.mesh = input.mesh_path;
    given.scene.occluder = input.occluder_paths;
    Rotation ignored;
    if (std::string error; !lightmap_rotation(ignored, given.light, error))
        throw py::value_error(error);
    std::vector<std::string> paths = input.paths();
    Image environment;
    const bool is_file = is_path(call.operands[1]);
    if (is_file) {
        given.environment.environment = path_text("environment", call.operands[1]);
        given.environment.cfem_params.sanitize = given.rays.sanitize;
        paths.push_back(given.environment.environment);
    } else {
        for (const char* name : { "colorspace", "colorconfig", "layer", "layout" })
            if (call.has(name))
                throw py::type_error(std::string(name) + ": only for an environment that is a file");
        environment = input_image("environment", call.operands[1]);
    }
    OIIO::ImageBuf dst;
    do_work(call.work, paths, [&](const MakeOptions& options, std::string& error) {
        OIIO::ImageBuf read;
        std::string note;
        if (is_file && !read_environment(read, given.environment, options, note, error))
            return false;
        return trace(dst, input, given, is_file ? read : environment.first(), options, error);
    });
    return own_one(std::move(dst));
}

} // namespace

void define_bakes(py::module_& m)
{
    const Signature<VismapRecipe> vismap({ "make_vismap",
                                           FunctionKind::function,
                                           kVismap,
                                           { mesh_operand(), occluder_operand() },
                                           "Image",
                                           kVismapReturns },
                                         { "mesh", "occluder" });
    m.def(
        "make_vismap",
        [vismap](const py::args& args, const py::kwargs& kwargs) {
            const auto [call, recipe] = vismap.read(args, kwargs);
            const MeshInput input = mesh_input(call.operands[0], call.operands[1]);
            return input.mesh ? bake_arrays(call, recipe.vismap_params, input) : bake_files(call, recipe, input);
        },
        docstring(vismap.function()).c_str());
    add_to_table("make_vismap", vismap.function());

    const Signature<ReferenceArguments> reference({ "make_reference",
                                                    FunctionKind::function,
                                                    kReference,
                                                    { mesh_operand(),
                                                      { "environment", "StrPath | Image | NDArray | ImageBuf",
                                                        "A lat-long map; one in memory must be in linear light" },
                                                      occluder_operand() },
                                                    "Image",
                                                    "R, G, B, their standard errors error.R, error.G, error.B, and "
                                                    "coverage: 1 where the mesh covers the texel" });
    m.def(
        "make_reference",
        [reference](const py::args& args, const py::kwargs& kwargs) {
            const auto [call, given] = reference.read(args, kwargs);
            return trace_reference(call, given);
        },
        docstring(reference.function()).c_str());
    add_to_table("make_reference", reference.function());
}

} // namespace vmlight::python
