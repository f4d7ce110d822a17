// SPDX-License-Identifier: Apache-2.0
#include "shoot.h"

#include <vmlight/base/frames.h>
#include <vmlight/cli/environment_options.h>
#include <vmlight/cli/main.h>
#include <vmlight/stage/reader.h>

#include <OpenImageIO/strutil.h>

using namespace vmlight;
using namespace vmlight::frames;

namespace {

constexpr const char* kExamples
    = "  vmframes shoe.glb studio.hdr -o shoe.png --exposure auto\n"
      "  vmframes shoe.glb studio.hdr -o shoe.####.png --frames 1-48 --turntable --ground white --exposure auto\n"
      "  vmframes walk.####.obj studio.hdr --vismap walk_vismap.####.exr -o walk.####.png --frames 1-24\n"
      "  vmframes hero.obj studio.hdr --vismap hero_vismap.exr --layers albedo,lit,depth -o hero.exr\n"
      "  vmframes hero.obj --texture 'hero_lit.<UDIM>.exr' -o hero.png\n"
      "  vmframes hero.obj sunny.hdr --ground white --suns auto --bounce auto -o hero.png\n"
      "  vmframes hero.obj sky.hdr --object hair.tfx --radius 0.0004:0.0001 --strand-color 0.2,0.1,0.05 -o hero.png\n"
      "  vmframes hero.obj sky.hdr --side-by-side ao,paper,lobe,reference -o compared.png";

StageMain::Take store_models(std::vector<std::string>& dst)
{
    return [&dst](OIIO::string_view text, std::string&) {
        dst = OIIO::Strutil::splits(text, ",");
        return true;
    };
}

// OIIO's texture system opens recipes by their readers, which are in this process already.
void declare_readers()
{
    static const char *vismap[] = { "vismap", nullptr }, *cfem[] = { "cfem", nullptr },
                      *lightmap[] = { "lightmap", nullptr };
    const auto declare = [](const char* name, OIIO::ImageInput::Creator creator, const char** extensions) {
        OIIO::declare_imageio_format(name, creator, extensions, nullptr, nullptr, "vmlight");
    };
    declare(
        "vismap", []() -> OIIO::ImageInput* { return new StageInput("vismap"); }, vismap);
    declare(
        "cfem", []() -> OIIO::ImageInput* { return new StageInput("cfem"); }, cfem);
    declare(
        "lightmap", []() -> OIIO::ImageInput* { return new StageInput("lightmap"); }, lightmap);
}

} // namespace

int main(int argc, const char** argv)
{
    declare_readers();
    Request request;
    StageMain stage("vmframes", "render pictures of a mesh, lit by its visibility map", { "MESH", "[ENVIRONMENT]" },
                    kExamples, OutputKind::Picture);
    stage.group("Output:");
    stage.option("frames", "RANGE",
                 "Frames to make, such as 1-48, with #### in -o; a MESH, --object, --vismap or --texture with #### has "
                 "a file for each",
                 [&](auto text, auto& error) {
                     request.has_frames = true;
                     return parse_frames(request.frames, std::string(text), error);
                 });
    stage.params("Output:", request.render);
    stage.params("Output:", request.sheet);
    stage.params("Camera:", request.camera);
    stage.params("Camera:", request.turn);
    stage.params("Scene:", request.stage);
    stage.group("Scene:");
    stage.option("vismap", "FILE", "Visibility map of the mesh, instead of baking one", request.object.vismap);
    stage.option("texture", "FILE", "Light to show on the mesh as it is: a lit texture, .tx, <UDIM> or a .lightmap",
                 request.object.texture);
    stage.group("Light:");
    stage.option("model", "NAME", "Shading model, as makelightmap has it, or reference: traced [auto]",
                 request.light.model);
    stage.option("wipe", "A,B", "Show two models, one to the left and one to the right",
                 store_models(request.sheet.wipe));
    stage.option("side_by_side", "A,B,...", "Show several models side by side, such as ao,paper,lobe,reference",
                 store_models(request.sheet.side_by_side));
    stage.option("explain", "", "Print before lighting which effects are simulated, and why",
                 [&](auto, auto&) { return request.explains = true; });
    stage.option("exposure", "-64..64|auto",
                 "Exposure in stops; auto: brings the mean luminance of the objects in the first frame to 0.18 [0]",
                 [&](OIIO::string_view text, std::string& error) {
                     request.is_auto_exposed = text == "auto";
                     return request.is_auto_exposed || set_param(request.light, "exposure", text, error);
                 });
    stage.params("Light:", request.light);
    stage.params("Light:", request.object.trace);
    stage.drop("ground_albedo"); // the ground here is a mesh, as white or coloured as others
    stage.params("Light:", request.display);
    add_environment_options(stage, request.filter);
    stage.params("Light:", request.filter.cfem_params, "cfem_");
    stage.params("Reference:", request.reference, "reference_");
    stage.params("Visibility map:", request.object.map.vismap_params);
    stage.drop("udim"); // every tile of the mesh is baked
    stage.drop("ground_height"); // the ground here is a mesh, below all objects
    stage.params("Mesh:", request.object.map.selection);
    stage.reword("material", "Show only this material of the file, * for any text; may be repeated");
    stage.reword("node", "Show only this node of the file and those below it, * for any text; may be repeated");
    stage.params("Mesh:", request.object.map.mesh_params);
    stage.params("Mesh:", request.object.map.cutout_params);
    stage.option("unwrap", "", "Replace the mesh's UVs, if any, by an atlas",
                 [&](auto, auto&) { return request.object.map.unwrap = true; });
    stage.params("Strands:", request.object.map.strand_params);
    stage.params("Strands:", request.specular);
    const auto complete = [&] {
        request.object.map.mesh = stage.operands()[0];
        request.environment = stage.operands().size() > 1 ? stage.operands()[1] : "";
        request.output = stage.output();
        request.object.map.mesh_params.fps = request.sheet.fps;
    };
    stage.unused([&](const std::string& name) {
        complete();
        return unused_reason(request.at(0), name);
    });
    stage.check([&] {
        complete();
        const std::string fault = operand_order_fault(request.object.map.mesh, request.environment);
        return fault.empty() ? request_fault(request) : fault;
    });
    return stage.run(argc, argv, [&](std::string& error) { return shoot(request, stage, error); });
}
