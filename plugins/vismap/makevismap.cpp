// SPDX-License-Identifier: Apache-2.0
#include <vmlight/image_file.h>
#include <vmlight/stage_main.h>
#include <vmlight/vismap.h>

#include <OpenImageIO/strutil.h>

using namespace vmlight;
using OIIO::Strutil::fmt::format;

namespace {

double percent(int64_t part, int64_t whole)
{
    return whole ? 100.0 * double(part) / double(whole) : 0.0;
}

void tell(StageMain& stage, const VismapReport& report, const OIIO::ImageSpec& spec)
{
    const UvReport& uv = report.uv;
    stage.say(format("uv: {} triangles cover {:.1f} % of {}x{} texels; {} texels overlap; triangles: {} reach out of "
                     "[0,1], {} mirrored, {} without area in uv, {} in space, {} without uv",
                     uv.triangles, percent(report.covered, report.texels), spec.width, spec.height, report.overlapping,
                     uv.outside, uv.mirrored, uv.degenerate_uv, uv.degenerate_3d, uv.without_uv));
    stage.say(format("bake: {:.2f} M rays in {:.2f} s, {:.2f} M rays/s; build {:.2f} s, margin {:.2f} s",
                     double(report.rays) * 1e-6, report.bake_seconds,
                     double(report.rays) * 1e-6 / std::max(report.bake_seconds, 1e-9), report.build_seconds,
                     report.margin_seconds));
    if (report.overlapping > 0)
        stage.warn(format("{} texels ({:.2f} % of those covered) belong to more than one triangle: the first triangle "
                          "of the file has them",
                          report.overlapping, percent(report.overlapping, report.covered)));
    if (uv.outside > 0)
        stage.warn(format("{} of {} triangles reach out of [0,1] in uv: what lies outside is not baked", uv.outside,
                          uv.triangles));
    if (uv.without_uv > 0)
        stage.warn(format("{} of {} triangles have no uv: they cast, and are not baked", uv.without_uv, uv.triangles));
    if (report.covered == 0)
        stage.warn("no texel centre is covered: the map is empty");
    else if (report.dark > report.covered / 2)
        stage.warn(format("{:.0f} % of the covered texels see nothing: do the normals point inwards?",
                          percent(report.dark, report.covered)));
}

} // namespace

int main(int argc, const char** argv)
{
    MeshParams mesh_params;
    VismapParams params;
    std::vector<std::string> occluder_paths;
    StageMain stage("makevismap", "bake how much each texel of a mesh sees, and which way on average", { "MESH" },
                    "  makevismap hero.obj -o hero_vismap.exr --resolution 2048 --samples 256\n"
                    "  makevismap hero.glb --occluder ground.obj --occluder tree.ply -o hero_vismap.exr");
    stage.params("Visibility:", params);
    stage.params("Mesh:", mesh_params);
    stage.option("occluder", "MESH", "A mesh that casts and is not baked; may come more than once",
                 [&](OIIO::string_view path, std::string&) {
                     occluder_paths.emplace_back(path);
                     return true;
                 });

    return stage.run(argc, argv, [&](std::string& error) {
        error = output_fault(stage.output());
        Mesh mesh;
        std::vector<Mesh> occluders(occluder_paths.size());
        if (!error.empty() || !read_mesh(mesh, stage.operand(0), mesh_params, error))
            return false;
        for (size_t i = 0; i < occluders.size(); ++i)
            if (!read_mesh(occluders[i], occluder_paths[i], mesh_params, error))
                return false;
        OIIO::ImageBuf vismap;
        VismapReport report;
        if (!make_vismap(vismap, mesh, occluders, params, &report, stage.threads(), stage.progress("bake"))) {
            error = vismap.geterror();
            return false;
        }
        append_params(vismap.specmod(), mesh_params);
        if (!stage.write(vismap, error))
            return false;
        tell(stage, report, vismap.spec());
        return true;
    });
}
