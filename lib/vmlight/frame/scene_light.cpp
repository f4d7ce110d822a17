// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/scene_light.h>

#include <vmlight/base/format.h>
#include <vmlight/cfem/suns.h>
#include <vmlight/image/channels.h>
#include <vmlight/stage/environment_file.h>
#include <vmlight/stage/light_color.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/stage/open_source.h>
#include <vmlight/stage/sun_source.h>

namespace vmlight {
namespace {

// The images of a CFEM, in the working space.
bool read_cfem(SceneLight& dst, const std::string& name, const CfemRecipe& recipe, const MakeOptions& options,
               std::string& error)
{
    LightmapRecipe light;
    light.cfem = name;
    light.colorspace = recipe.colorspace;
    light.colorconfig = recipe.colorconfig;
    const PixelSourcePointer source = open_input(light, "cfem", name, InputKind::Cfem, error, {});
    LightColor color;
    if (!source || !describe_light(color, light, source->spec(), error)
        || !make_input(dst.filtered, *source, { 0, source->subimages() }, light, "cfem", name, options, error))
        return false;
    if (dst.filtered[0].spec().find_attribute(kSunsAttribute)) {
        std::string text;
        error = recipe.suns != "off" ? ""
                                     : "its suns were split off (makecfem --suns auto), and without them it is too "
                                       "dark; set --suns on, or give the environment itself";
        if (!error.empty() || !find_suns(text, *source, error) || !parse_suns(dst.suns, text, error)) {
            error = format("\"{}\": {}", name, error);
            return false;
        }
    }
    if (kernel_of(dst.filtered[0].spec()) != kCosineKernel) {
        error = format("\"{}\": filtered by the kernel {}: the light of strands, not of meshes", name,
                       kernel_of(dst.filtered[0].spec()));
        return false;
    }
    color.convert(dst.filtered, options.threads);
    color.convert(dst.suns);
    for (const std::string& warning : color.warnings)
        options.report_warning(warning);
    return true;
}

} // namespace

bool SceneLight::open(const std::string& name, CfemRecipe recipe, bool keep_environment, const MakeOptions& options,
                      std::string& error)
{
    suns.clear();
    if (image_stage(name) == kCfemStage) {
        if (!read_cfem(*this, name, recipe, options, error))
            return false;
    } else {
        recipe.environment = name;
        std::string note;
        if (!make_images(filtered, recipe, options, error)
            || (keep_environment && !read_environment(environment, recipe, options, note, error))) {
            error = with_filter_prefix(error);
            return false;
        }
        const std::string text = filtered[0].spec().get_string_attribute(kSunsAttribute);
        if (!text.empty() && !parse_suns(suns, text, error))
            return false;
    }
    space = filtered[0].spec().get_string_attribute("colorInteropID");
    return true;
}

bool object_pose(Rotation& dst, const LightmapParams& params, std::string& error)
{
    LightmapParams own = params;
    own.env_rotate.clear();
    own.model = "auto"; // the rotation is that of every model, and of the reference
    return lightmap_rotation(dst, own, error);
}

LightmapParams turned_light(const LightmapParams& params, const Rotation& pose, double degrees)
{
    const Rotation rotation = rotation_from_angles(0, degrees, 0) * pose;
    LightmapParams turned = params;
    turned.exposure = 0;
    turned.rotate.clear();
    turned.quaternion.clear();
    turned.matrix.assign(&rotation[0][0], &rotation[0][0] + 9);
    return turned;
}

} // namespace vmlight
