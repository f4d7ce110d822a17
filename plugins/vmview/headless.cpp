// SPDX-License-Identifier: Apache-2.0
#include "headless.h"

#include "bench.h"
#include "gl/fault.h"
#include "gl/headless.h"
#include "render/lighting.h"
#include "render/picture.h"
#include "scene/added_light.h"

#include <vmlight/base/format.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/frame/scene_light.h>
#include <vmlight/image/color.h>
#include <vmlight/image/picture_file.h>
#include <vmlight/lightmap/light_level.h>

#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

namespace vmlight::view {
namespace {

bool frame_object(PictureParams& dst, const MeshAsset& mesh, const Request& request, std::string& error)
{
    Rotation pose;
    if (!object_pose(pose, request.light, error) || !lightmap_rotation(dst.to_environment, request.light, error))
        return false;
    const Size size = request.render.size;
    const double aspect = double(size.width) / size.height;
    const Subject subject = subject_of(mesh, pose);
    Camera camera;
    if (request.camera.camera.empty())
        camera = place_camera(request.camera, subject, aspect, false);
    else if (!find_camera(camera, request.camera, *mesh.mesh, aspect, error))
        return false;
    dst.view.camera = camera_for(camera, pose);
    return true;
}

bool add_traced_light(Renderer& renderer, const Assets& assets, const Request& request, const LightmapParams& light,
                      std::string& error)
{
    if (!assets.light || !assets.trace.has_any() || !is_light(request.view.show))
        return true;
    AddedTexels rgb;
    AddedLight added(assets.trace, assets.mesh, request.view.white, assets.map, assets.light);
    if (!added.trace(rgb, light, {}, error))
        return false;
    renderer.add_light(0, std::move(rgb));
    return true;
}

// As vmframes measures: of a quarter of the size, what the object covers.
double automatic_stops(Renderer& renderer, PictureParams params, RenderParams render, const std::string& space,
                       std::string& error)
{
    render.size = { std::max(1, render.size.width / 4), std::max(1, render.size.height / 4) };
    render.spp = 1;
    params.has_background = false;
    OIIO::ImageBuf image;
    if (!render_picture(image, renderer, params, render, error))
        return 0;
    const double mean = covered_luminance(image, space);
    return GrayExposure::of(mean).stops;
}

} // namespace

bool render_headless(OIIO::ImageBuf& dst, const Assets& assets, const Request& request, std::string& error)
{
    const auto context = HeadlessContext::open(error);
    if (!context)
        return false;
    Renderer renderer;
    PictureParams params;
    LightmapParams light;
    const bool has_background = request.view.background == "environment";
    if (!renderer.build(error) || !renderer.set_mesh(assets.mesh, !request.view.white, error)
        || !renderer.set_map(assets.map, error) || !renderer.set_light(assets.light, error)
        || !light_params(light, request.light, 0, error) || !add_traced_light(renderer, assets, request, light, error)
        || !show_surface(renderer, 0, request.view.show, light, error)
        || !frame_object(params, *assets.mesh, request, error))
        return false;
    if (has_background && !assets.light->panorama) {
        error = format("\"{}\": --background environment needs the environment itself, and this is only its filtered "
                       "map",
                       request.environment);
        return false;
    }
    params.has_background = has_background;
    params.show = surface_show(request.view.show);
    const bool is_lit = is_light(request.view.show);
    const std::string space = assets.light ? assets.light->light.space : "";
    double stops = request.light.exposure;
    if (is_lit && request.is_auto_exposed)
        stops = automatic_stops(renderer, params, request.render, space, error);
    if (!render_picture(dst, renderer, params, request.render, error)) {
        error = format("OpenGL: {}", error);
        return false;
    }
    if (!is_lit) {
        dst.specmod().attribute("colorInteropID", "data");
        return true;
    }
    const float gain = float(std::exp2(stops));
    OIIO::ImageBufAlgo::mul(dst, dst, { gain, gain, gain, 1.0f });
    dst.specmod().attribute("vmlight:exposure", float(stops));
    if (space.empty())
        dst.specmod().attribute("colorInteropID", "unknown");
    else
        tag_scene_linear(dst.specmod(), space);
    return true;
}

bool run_headless(const Request& request, StageMain& stage, std::string& error)
{
    const MakeOptions options = stage.make_options();
    Assets assets;
    OIIO::ImageBuf picture;
    if (!load_assets(assets, request, options, error))
        return false;
    if (request.view.bench > 0 && !bench_frames(assets, request, stage, error))
        return false;
    if (request.output.empty())
        return true;
    const Stopwatch timer;
    if (!render_headless(picture, assets, request, error))
        return false;
    stage.say(format("render: {}x{} in {:.2f} s", request.render.size.width, request.render.size.height, timer()));
    if (OIIO::Strutil::iends_with(request.output, ".exr"))
        return stage.write(picture, error);
    if (!is_light(request.view.show)) {
        show_numbers(picture);
        return write_picture(picture, request.output, error);
    }
    std::string note;
    if (!show_on_display(picture, request.display, assets.light ? assets.light->light.space : "",
                         request.filter.colorconfig, options.threads, note, error))
        return false;
    stage.say(note);
    return write_picture(picture, request.output, error);
}

} // namespace vmlight::view
