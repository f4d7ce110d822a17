// SPDX-License-Identifier: Apache-2.0
#include "bench.h"

#include "display/display_config.h"
#include "display/display_pass.h"
#include "gl/fault.h"
#include "gl/headless.h"
#include "render/lighting.h"
#include "render/picture.h"
#include "scene/added_light.h"

#include <vmlight/base/format.h>
#include <vmlight/base/stopwatch.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace vmlight::view {

bool bench_frames(const Assets& assets, const Request& request, StageMain& stage, std::string& error)
{
    const auto context = HeadlessContext::open(error);
    if (!context)
        return false;
    Renderer renderer;
    DisplayConfig config;
    DisplayPass display;
    DisplayChoice choice { request.display.display, request.display.view, request.display.look };
    const Size size = request.render.size;
    PictureParams params;
    params.has_background = request.view.background == "environment";
    params.show = surface_show(request.view.show);
    if (!renderer.build(error) || !renderer.set_mesh(assets.mesh, !request.view.white, error)
        || !renderer.set_map(assets.map, error) || !renderer.set_light(assets.light, error)
        || !config.open(request.filter.colorconfig, error) || !config.settle(choice, error)
        || !display.build(config.processor(choice, error), error))
        return false;
    const Camera camera = place_camera(request.camera, assets.mesh->subject, double(size.width) / size.height, true);
    const Framebuffer screen(size.width, size.height, GL_RGBA8, false);
    PictureSum sum;
    sum.start(size.width, size.height, 1, request.render.filter);
    std::vector<double> times;
    double relight = 0, draw = 0; // of all frames
    std::optional<AddedLight> added;
    if (assets.light && assets.trace.has_any() && is_light(request.view.show))
        added.emplace(assets.trace, assets.mesh, request.view.white, assets.map, assets.light);
    // One more than asked for: the first compiles.
    for (int i = 0; i <= request.view.bench; ++i) {
        const Stopwatch timer;
        const double turn = 360.0 * i / request.view.bench;
        LightmapParams light;
        AddedTexels rgb;
        if (!light_params(light, request.light, turn, error) || (added && !added->trace(rgb, light, {}, error)))
            return false;
        renderer.add_light(0, std::move(rgb));
        if (!show_surface(renderer, 0, request.view.show, light, error)
            || !lightmap_rotation(params.to_environment, light, error))
            return false;
        glFinish();
        const double relit = timer();
        params.view.camera = turned(camera, turn, assets.mesh->subject.centre());
        sum.start(size.width, size.height, 1, request.render.filter);
        sum.add(renderer, params);
        glFinish();
        const double drawn = timer();
        screen.bind();
        display.run(sum.mean(), float(std::exp2(request.light.exposure)), size.width, size.height);
        glFinish();
        if (i > 0) {
            times.push_back(1000 * timer());
            relight += 1000 * relit;
            draw += 1000 * (drawn - relit);
        }
    }
    error = gl_fault();
    if (!error.empty())
        return false;
    std::sort(times.begin(), times.end());
    const auto* driver = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    const size_t p99 = std::min(times.size() - 1, size_t(std::ceil(0.99 * double(times.size()))) - 1);
    const double frames = double(times.size()), total = std::accumulate(times.begin(), times.end(), 0.0);
    stage.say(format("bench: {} frames of {}x{}: median {:.2f} ms, p99 {:.2f} ms; mean of relighting {:.2f}, drawing "
                     "{:.2f}, display {:.2f} ({})",
                     times.size(), size.width, size.height, times[times.size() / 2], times[p99], relight / frames,
                     draw / frames, (total - relight - draw) / frames, driver ? driver : "unknown"));
    return true;
}

} // namespace vmlight::view
