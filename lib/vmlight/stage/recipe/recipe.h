// SPDX-License-Identifier: Apache-2.0
/// Recipes: a stage as a small TOML file that opens as an image, computed on first read.
///     # hero.lightmap
///     vismap = "hero.vismap"
///     environment = "studio.exr"
///     rotate = [0, 90, 0]
/// Each recipe is one struct: the stage's inputs and its params. visit() names the keys, ?query keys, flags and
/// metadata, all spelled alike. The file is flat: no tables, and single-line strings in single or double quotes.
/// Relative paths start at the folder of the recipe; in a query or a flag, at the current folder. UDIM: every recipe
/// has the key `udim`, a tile number that replaces "<UDIM>" in its paths; for a vismap it also selects the tile to
/// bake. If the key is not set, the file's name may give the tile, as in "hero.1011.lightmap", so that one file under
/// several names serves "hero.<UDIM>.lightmap". Otherwise it is 1001.
#pragma once

#include <vmlight/base/export.h>
#include <vmlight/base/params.h>
#include <vmlight/cfem/cfem.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/mesh/selection.h>
#include <vmlight/mesh/strands.h>
#include <vmlight/stage/recipe/shared_keys.h>
#include <vmlight/uv/udim.h>
#include <vmlight/vismap/normal_map_params.h>
#include <vmlight/vismap/vismap.h>

#include <string>
#include <vector>

namespace vmlight {

/// `hero.vismap`
struct VismapRecipe
{
    static constexpr const char* kStage = "vismap";
    std::string mesh;
    std::vector<std::string> occluder;
    /// Replace the UVs of the mesh by an atlas for this resolution and margin: see unwrap_mesh(). Only tile 1001.
    bool unwrap = false;
    MeshParams mesh_params;
    /// Of `mesh`; occluders are all there.
    MeshSelection selection;
    /// An image in the UVs that are baked, "" for none.
    std::string normal_map;
    /// Instead: those that the materials of `mesh` name.
    bool material_normals = false;
    NormalMapParams normal_map_params;

    bool has_normal_map() const { return !normal_map.empty() || material_normals; }
    VismapParams vismap_params;
    /// Of the mesh and its occluders.
    CutoutParams cutout_params;
    /// If `mesh` or an occluder is a file of strands: see bakes_strands().
    StrandParams strand_params;
    /// Switches of effects: see effects/switches.h. "auto" is what the scene calls for.
    std::string effects = "auto";
    /// Whether occluders are left out of the scene that no ray of the mesh's texels can meet. Changes no visibility,
    /// and so is no parameter.
    bool cull_occluders = true;
    /// Seconds that the bake may take; 0 is no limit. Set by a command line only: machines differ, recipes do not.
    double time_budget = 0;
    /// Whether the recipe, its name, a query or a flag gave the tile.
    bool udim_given = false;

    template <class Visit> void visit(Visit&& field)
    {
        field("mesh", mesh, Path {}, "Mesh to bake");
        field("occluder", occluder, Paths {}, "Mesh or strands that occlude but are not baked");
        selection.visit(field);
        field("unwrap", unwrap, Flag {},
              "Replace the mesh's UVs, if any, by an atlas made for this resolution and margin");
        field("normal_map", normal_map, Path {}, "Normal map of the mesh, in the UVs that are baked");
        field("material_normals", material_normals, Flag {},
              "Use the normal maps that the mesh's materials name: glTF's normalTexture, MTL's norm");
        normal_map_params.visit(field);
        vismap_params.visit(field);
        visit_effects(field, effects,
                      advanced("Effects to simulate: auto, all, or switches such as -ground,+self-occlusion; "
                               "--explain lists them"));
        mesh_params.visit(field);
        cutout_params.visit(field);
        strand_params.visit(field);
    }
};

/// `studio.cfem`
struct CfemRecipe
{
    static constexpr const char* kStage = "cfem";
    std::string environment;
    /// Its colour space, "" to detect it from name and labels; the OCIO config, "" for $OCIO.
    std::string colorspace, colorconfig;
    /// Its layer or part, "" for the channels R, G, B of the first part; the colour space of the result, "" for the
    /// working space.
    std::string layer, output_colorspace;
    std::string layout = "auto";
    CfemParams cfem_params;
    /// Make a stack (cfem/stack.h): the CFEM is then the first of several images in one file.
    bool stack = false;
    /// `auto`: filter what is left when the suns are split off (cfem/suns.h); they go to the metadata.
    std::string suns = "off";
    int udim = kFirstUdim;
    /// Whether the recipe, its name, a query or a flag gave the tile.
    bool udim_given = false;

    template <class Visit> void visit(Visit&& field)
    {
        field("environment", environment, Path {}, "Lat-long environment to filter");
        field("colorspace", colorspace, Text { "SPACE" },
              advanced("Colour space of the environment; default: from its name and metadata"));
        field("colorconfig", colorconfig, Path {}, advanced("OCIO config; default: $OCIO"));
        visit_image(field, layer, layout, output_colorspace);
        field("stack", stack, Flag {},
              "Write a stack: filters of several widths and the environment itself, for all models");
        field("suns", suns, suns_choices(false), "Suns to split off, for makelightmap --suns auto");
        field("kernel", cfem_params.kernel, kernel_choices(), "What to light: surfaces or strands");
        field("udim", udim, Range { kFirstUdim, kLastUdim }, "UDIM tile; replaces <UDIM> in file names");
        cfem_params.visit(field);
    }
};

/// `hero.lightmap`: needs exactly one of `environment` and `cfem`.
struct LightmapRecipe
{
    static constexpr const char* kStage = "lightmap";
    std::string vismap, environment, cfem, albedo;
    std::string colorspace, colorconfig, albedo_colorspace, layer, albedo_layer, output_colorspace;
    std::string layout = "auto";
    /// As VismapRecipe::effects.
    std::string effects = "auto";
    LightmapParams lightmap_params;
    /// `on`: split the suns off the environment, or use those that the CFEM was split into, and trace their shadows
    /// on the mesh of the visibility map. `auto`: unless that mesh is not known.
    std::string suns = "off";
    BounceParams bounce_params;
    /// That mesh, and what else casts shadows on it, if `vismap` is a file; its recipe names them otherwise.
    std::string mesh;
    std::vector<std::string> occluder;
    /// How the environment is filtered: keys cfem_filter, cfem_order, cfem_resolution, cfem_sanitize.
    CfemParams cfem_params;
    int udim = kFirstUdim;
    /// Whether the recipe, its name, a query or a flag gave the tile.
    bool udim_given = false;

    template <class Visit> void visit(Visit&& field)
    {
        field("vismap", vismap, Path {}, "Visibility map, or its recipe");
        field("environment", environment, Path {}, "Lat-long environment to light with; it is filtered first");
        field("cfem", cfem, Path {}, "Cosine-filtered environment, or its recipe");
        field("albedo", albedo, Path {}, "Albedo texture to multiply by; converted to scene-linear");
        field("albedo_colorspace", albedo_colorspace, Text { "SPACE" },
              advanced("Colour space of the albedo; default: from its name and metadata"));
        field("colorspace", colorspace, Text { "SPACE" },
              advanced("Colour space of the environment or CFEM; default: from its name and metadata"));
        field("colorconfig", colorconfig, Path {}, advanced("OCIO config; default: $OCIO"));
        field("albedo_layer", albedo_layer, Text { "LAYER" }, advanced("Layer or part of the albedo file to read"));
        visit_image(field, layer, layout, output_colorspace);
        field("udim", udim, Range { kFirstUdim, kLastUdim }, "UDIM tile; replaces <UDIM> in file names");
        lightmap_params.visit(field);
        visit_suns(field, suns);
        bounce_params.visit(field);
        field("mesh", mesh, Path {}, "Mesh of the visibility map, to trace light on; a recipe of a map names it");
        field("occluder", occluder, Paths {}, "Mesh that occluded the visibility map, to trace light against");
        visit_effects(field, effects,
                      advanced("Effects to simulate: auto, all, or switches such as -albedo,+stack-levels; --explain "
                               "lists them"));
        cfem_params.visit([&](const char* name, auto& value, const auto& allowed, const char* help) {
            field(("cfem_" + std::string(name)).c_str(), value, allowed, advanced(help));
        });
    }
};

/// Every recipe, one per stage, in the order of the pipeline: a new stage adds its line here.
#define VMLIGHT_RECIPES(APPLY)                                                                                         \
    APPLY(VismapRecipe)                                                                                                \
    APPLY(CfemRecipe)                                                                                                  \
    APPLY(LightmapRecipe)

/// The tile of a recipe.
inline int& udim_of(VismapRecipe& recipe)
{
    return recipe.vismap_params.udim;
}
template <class Recipe> int& udim_of(Recipe& recipe)
{
    return recipe.udim;
}

/// Read a recipe: the file before '?', then the overrides after it ("hero.lightmap?rotate=0,45,0&exposure=1").
/// The first '?' behind the recipe's extension starts the overrides, '&' separates them, and nothing is %-decoded: a
/// value with '&' must be in the file. Only a key that takes several paths or names may repeat. The file must exist.
///
/// @param error    set to one line that names file, key and line number, if the result is false
/// @returns false if the file cannot be read, is empty, larger than 1 MiB or not TOML, a key is unknown (the error
///          suggests the nearest) or repeated, a value is of the wrong type or out of range. Not checked: that the
///          inputs exist.
template <class Recipe> bool read_recipe(Recipe& dst, const std::string& name, std::string& error);

/// Like read_recipe(), from the contents of the file `path`, which need not exist.
template <class Recipe>
bool read_recipe_text(Recipe& dst, OIIO::string_view text, const std::string& path, std::string& error);

/// The TOML text that read_recipe_text() reads back as the same recipe: values that differ from the defaults, and
/// `udim` if it was given or the name of the file gives one. The text is for the file `path`: relative paths, which in
/// `recipe` start at the current folder, start at its folder. Of paths, only <UDIM> is kept as it is.
template <class Recipe> std::string recipe_text(const Recipe& recipe, const std::string& path = "");

/// The stage of the recipe `name` (a path, with or without ?query), from its extension: "vismap", "cfem" or "lightmap".
/// "" for any other extension.
VMLIGHT_API std::string recipe_stage(const std::string& name);

/// Whether `name` (a path, with or without ?query) has the extension of a recipe.
VMLIGHT_API bool is_recipe_name(const std::string& name);

/// The path in a recipe's name: everything before its ?query. Folders and files may have a '?' in their names.
VMLIGHT_API std::string recipe_path(const std::string& name);

/// Where a recipe sets a key, as the start of a message: `"hero.lightmap" line 3: albedo`; without a line if the key is
/// set after '?' or not at all. Reads the file again: for error messages only.
VMLIGHT_API std::string recipe_place(const std::string& name, const std::string& key);

#define VMLIGHT_DECLARE(Recipe)                                                                                        \
    extern template VMLIGHT_API bool read_recipe(Recipe&, const std::string&, std::string&);                           \
    extern template VMLIGHT_API bool read_recipe_text(Recipe&, OIIO::string_view, const std::string&, std::string&);   \
    extern template VMLIGHT_API std::string recipe_text(const Recipe&, const std::string&);
VMLIGHT_RECIPES(VMLIGHT_DECLARE)
#undef VMLIGHT_DECLARE

} // namespace vmlight
