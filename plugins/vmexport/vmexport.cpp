// SPDX-License-Identifier: Apache-2.0
#include "write_textures.h"

#include <vmlight/cli/environment_options.h>
#include <vmlight/cli/main.h>

using namespace vmlight;
using namespace vmlight::exporting;

namespace {

constexpr const char* kExamples
    = "  vmexport hero_vismap.exr --for godot --mesh hero.glb -o textures\n"
      "  vmexport hero_vismap.exr --for unity --mesh hero.glb --pack hero_mask_map.png -o textures\n"
      "  vmexport 'hero_vismap.<UDIM>.exr' --for unreal --mesh hero.obj --depth 16 -o textures\n"
      "  vmexport hero_vismap.exr --for three --lightmap hero_lit.exr --lightmap-encoding rgbe -o textures\n"
      "  vmexport hero_sh.exr --for godot --maps sh -o textures\n"
      "  vmexport hero_vismap.exr --mesh hero.glb --lightmap hero_lit.exr --gltf hero_lit.glb\n"
      "  vmexport hero_vismap.exr --mesh hero.glb --environment studio.hdr --environment sky.hdr --html hero.html";

} // namespace

int main(int argc, const char** argv)
{
    Request request;
    StageMain stage("vmexport", "write a visibility map as textures for game engines", { "VM" }, kExamples,
                    OutputKind::OptionalFolder);
    stage.params("Textures:", request.params);
    stage.params("Inputs:", request.files);
    stage.params("Textures:", request.gltf_light);
    stage.group("Inputs:");
    add_environment_options(stage, request.filter);
    const auto complete = [&] {
        request.vismap = stage.operands()[0];
        request.folder = stage.output();
    };
    stage.unused([&](const std::string& name) {
        complete();
        return unused_reason(request, name);
    });
    stage.check([&] {
        complete();
        return request_fault(request);
    });
    return stage.run(argc, argv,
                     [&](std::string& error) { return write_textures(request, stage.make_options(), error); });
}
