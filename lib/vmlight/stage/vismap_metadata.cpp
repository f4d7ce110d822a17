// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/vismap_metadata.h>

#include <vmlight/base/params.h>
#include <vmlight/stage/bake_switches.h>
#include <vmlight/stage/recipe/recipe_effects.h>

#include <OpenImageIO/filesystem.h>

#include <string>

namespace vmlight {

void append_mesh_metadata(OIIO::ImageSpec& spec, const VismapRecipe& recipe)
{
    append_params(spec, recipe.mesh_params);
    // A map of the whole mesh in its own UVs, at no frame, has the metadata that it always had.
    if (recipe.mesh_params.frame == MeshParams::kFirstSample)
        for (const char* name : { "frame", "fps" })
            spec.erase_attribute(metadata_name(name));
    if (recipe.mesh_params.terrain.empty())
        for (const char* name : { "terrain", "height_scale" })
            spec.erase_attribute(metadata_name(name));
    if (recipe.cutout_params.cutouts == "off") // `auto` is known once the files are read
        append_params(spec, recipe.cutout_params);
    if (!recipe.strand_params.radius.empty()) // of occluders
        spec.attribute(metadata_name("radius"), recipe.strand_params.radius);
    if (recipe.unwrap)
        spec.attribute(metadata_name("unwrap"), value_text(recipe.unwrap, Flag {}));
    if (!recipe.normal_map.empty()) {
        spec.attribute(metadata_name("normal_map"), OIIO::Filesystem::filename(recipe.normal_map));
        append_params(spec, recipe.normal_map_params);
    }
    if (recipe.material_normals) {
        spec.attribute(metadata_name("material_normals"), value_text(recipe.material_normals, Flag {}));
        append_params(spec, recipe.normal_map_params);
    }
    if (const std::string off = switched_off(recipe.effects, VismapRecipe::kStage); !off.empty())
        spec.attribute(metadata_name("effects"), off);
    MeshSelection selection = recipe.selection;
    selection.visit([&](const char* name, auto& value, const auto& allowed, const char*) {
        if (!value.empty())
            spec.attribute(metadata_name(name), value_text(value, allowed));
    });
}

void append_no_reconstruct(OIIO::ImageSpec& spec, const VismapRecipe& given)
{
    if (given.vismap_params.reconstruct == "off")
        return;
    if (const std::string reason = why_not_reconstructed(given); !reason.empty())
        spec.attribute(metadata_name("no_reconstruct"), reason);
}

} // namespace vmlight
