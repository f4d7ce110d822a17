// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/strand_files.h>

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/strands/read_strands.h>

namespace vmlight {

bool read_strand_file(Strands& dst, StrandLayout& layout, std::vector<FileStamp>& files, const VismapRecipe& recipe,
                      const SceneStamps& stamps, std::string& at, std::string& error)
{
    at = "mesh";
    if (!read_strands(dst, recipe.mesh, recipe.mesh_params, recipe.strand_params.radius, error,
                      [&](const std::string& path) { note_file(files, path); })
        || !check_stamp(stamps.files[0], recipe.mesh, error))
        return false;
    at = "strand_texels";
    return StrandLayout::make(layout, dst.count(), recipe.strand_params.strand_texels, error);
}

bool read_strand_uvs(Strands& dst, std::vector<Imath::V2f>& uvs, const VismapRecipe& recipe, std::string& error)
{
    StrandLayout layout;
    if (!read_strands(dst, recipe.mesh, recipe.mesh_params, recipe.strand_params.radius, error)
        || !StrandLayout::make(layout, dst.count(), recipe.strand_params.strand_texels, error))
        return false;
    uvs = strand_uvs(dst, layout);
    return true;
}

bool build_strand_scene(StrandScene& dst, StrandSceneFacts& facts, const Strands& strands, const VismapRecipe& recipe,
                        const SceneStamps& stamps, const MakeOptions& options, std::string& at, std::string& error)
{
    std::vector<Mesh> occluders(recipe.occluder.size());
    for (size_t i = 0; i < occluders.size(); ++i) {
        if (!read_scene_file(occluders[i], facts.files, recipe, stamps, i + 1, options.steps(), at, error))
            return false;
        facts.occluder_hashes += (i ? "," : "") + mesh_hash(occluders[i]);
        facts.occluder_names += (i ? ", " : "") + occluders[i].name;
        for (const std::string& warning : occluders[i].warnings)
            facts.warnings.push_back(format("\"{}\": {}", occluders[i].path, warning));
    }
    at = "mesh";
    return dst.build(strands, occluders, options.threads, error, options.steps());
}

} // namespace vmlight
