// SPDX-License-Identifier: Apache-2.0
#include "headless.h"
#include "request.h"
#include "ui/app.h"

#include <vmlight/base/format.h>
#include <vmlight/cli/environment_options.h>
#include <vmlight/cli/main.h>
#include <vmlight/uv/udim.h>

#include <utility>

using namespace vmlight;
using namespace vmlight::view;

namespace {

constexpr const char* kExamples = "  vmview shoe.glb studio.hdr\n"
                                  "  vmview hero.obj studio.hdr --vismap hero_vismap.exr --model paper\n"
                                  "  vmview hair.tfx studio.hdr --radius 0.0004:0.0001 --strand-color 0.3,0.12,0.05\n"
                                  "  vmview body.obj studio.hdr --object hair.tfx --radius 0.0004:0.0001\n"
                                  "  vmview hero.obj studio.hdr --headless --rotate 0,90,0 -o hero.exr\n"
                                  "  vmview hero.obj studio.hdr --bench 200 --size 1920x1080";

} // namespace

int main(int argc, const char** argv)
{
    Request request;
    request.render.size = { 1280, 720 };
    StageMain stage("vmview", "look at a mesh or strands, lit by their visibility map, while they turn",
                    { "[MESH]", "[ENVIRONMENT]" }, kExamples, OutputKind::OptionalPicture);
    stage.params("Picture:", request.view);
    stage.group("Picture:");
    stage.option("size", "WxH",
                 "Width and height of the window or picture in pixels; one number for a square [1280x720]",
                 [&](auto text, auto& error) {
                     request.size_given = true;
                     return set_param(request.render, "size", text, error);
                 });
    stage.option("spp", "1..4096", "Samples per pixel of a picture, and of a window at rest [16]",
                 [&](auto text, auto& error) { return set_param(request.render, "spp", text, error); });
    stage.option("filter", "NAME", advanced("Pixel filter, as vmframes has it [blackman-harris]"),
                 [&](auto text, auto& error) { return set_param(request.render, "filter", text, error); });
    for (const auto& [name, help] :
         { std::pair { "display", "Display of the OCIO config; default: the last one, or the config's" },
           std::pair { "view", "View of that display; default: the last one, or the display's" },
           std::pair { "look", "Look instead of the view's own" } })
        stage.option(name, "NAME", help, [&request, name = std::string(name)](auto text, auto& error) {
            request.display_given = true;
            return set_param(request.display, name, text, error);
        });
    stage.params("Camera:", request.camera);
    stage.group("Light:");
    stage.option("vismap", "FILE", "Visibility map of MESH, instead of baking one", request.vismap);
    stage.option("model", "NAME", "Shading model, as makelightmap has it [auto]", [&](auto text, auto& error) {
        request.model_given = true;
        return set_param(request.light, "model", text, error);
    });
    stage.option("exposure", "-64..64|auto",
                 "Exposure in stops; auto: brings the mean luminance of the object to 0.18 [0; in a window auto]",
                 [&](OIIO::string_view text, std::string& error) {
                     request.is_auto_exposed = text == "auto";
                     request.exposure_given = !request.is_auto_exposed;
                     return request.is_auto_exposed || set_param(request.light, "exposure", text, error);
                 });
    stage.params("Light:", request.light);
    stage.params("Light:", request.trace);
    add_environment_options(stage, request.filter);
    stage.params("Light:", request.filter.cfem_params, "cfem_");
    stage.group("Visibility map:");
    stage.option("udim", format("{}..{}", kFirstUdim, kLastUdim),
                 "UDIM tile to light; replaces <UDIM> in --vismap [the first that the mesh uses]",
                 [&](auto text, auto& error) {
                     request.mesh.udim_given = true;
                     return set_param(request.mesh, "udim", text, error);
                 });
    stage.params("Visibility map:", request.mesh.vismap_params);
    stage.params("Mesh:", request.mesh.selection);
    stage.reword("material", "Show only this material of the file, * for any text; may be repeated");
    stage.reword("node", "Show only this node of the file and those below it, * for any text; may be repeated");
    stage.params("Mesh:", request.mesh.mesh_params);
    stage.params("Mesh:", request.mesh.cutout_params);
    stage.option("unwrap", "", "Replace the mesh's UVs, if any, by an atlas",
                 [&](auto, auto&) { return request.mesh.unwrap = true; });
    stage.params("Strands:", request.mesh.strand_params);
    stage.params("Strands:", request.specular);
    const auto complete = [&] {
        const std::vector<std::string>& operands = stage.operands();
        request.mesh.mesh = operands.empty() ? "" : operands[0];
        request.environment = operands.size() > 1 ? operands[1] : "";
        request.output = stage.output();
    };
    stage.unused([&](const std::string& name) {
        complete();
        return unused_reason(request, name);
    });
    stage.check([&] {
        complete();
        const std::string fault = operand_order_fault(request.mesh.mesh, request.environment);
        return fault.empty() ? request_fault(request) : fault;
    });
    return stage.run(argc, argv, [&](std::string& error) {
        return request.has_window() ? run_window(request, stage.make_options().threads, error)
                                    : run_headless(request, stage, error);
    });
}
