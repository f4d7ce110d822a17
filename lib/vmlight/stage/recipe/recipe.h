// SPDX-License-Identifier: Apache-2.0
/// Recipes: a stage as a small TOML file, read instead of an image and made on first read.
///     # hero.lightmap
///     vismap = "hero.vismap"
///     environment = "studio.exr"
///     rotate = [0, 90, 0]
/// Each recipe is one struct: what the stage reads, and its params. Keys, ?query keys, flags and metadata are those of
/// visit(), with one spelling. It is flat: no tables, and texts of one line, in single or double quotes. Paths in a
/// recipe start at its folder; those in a query or a flag where the user stands.
/// UDIM: every recipe has the key `udim`, a tile's number, which "<UDIM>" in any of its paths stands for; for a vismap
/// it is the part of uv space that is baked, too. Where it is not set, the recipe's own name may say it, as in
/// "hero.1011.lightmap", so that one file under several names serves "hero.<UDIM>.lightmap"; else it is 1001.
#pragma once

#include <vmlight/base/export.h>
#include <vmlight/base/params.h>
#include <vmlight/cfem/cfem.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/uv/udim.h>
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
    MeshParams mesh_params;
    VismapParams vismap_params;
    /// Seconds that the bake may take, 0 for no limit: of a command line alone. Machines differ, recipes do not.
    double time_budget = 0;
    /// Whether the tile was said: by the recipe, its name, a query or a flag.
    bool udim_given = false;

    template <class Visit> void visit(Visit&& field)
    {
        field("mesh", mesh, Path {}, "The mesh to bake");
        field("occluder", occluder, Paths {}, "Meshes that cast and are not baked");
        vismap_params.visit(field);
        mesh_params.visit(field);
    }
};

/// `studio.cfem`
struct CfemRecipe
{
    static constexpr const char* kStage = "cfem";
    std::string environment;
    /// Its colour space, "" if its name and tags tell; the OCIO config, "" for $OCIO.
    std::string colorspace, colorconfig;
    CfemParams cfem_params;
    /// Make a stack (cfem_stack.h): the CFEM is then the first of several images in one file.
    bool stack = false;
    int udim = kFirstUdim;
    /// Whether the tile was said: by the recipe, its name, a query or a flag.
    bool udim_given = false;

    template <class Visit> void visit(Visit&& field)
    {
        field("environment", environment, Path {}, "The lat-long map to filter");
        field("colorspace", colorspace, Text {}, "Colour space of the environment, if its name and tags do not tell");
        field("colorconfig", colorconfig, Path {}, "OCIO config; without it $OCIO");
        field("stack", stack, Flag {},
              "Add lobes wider and narrower than the cosine, and the environment itself: for all models");
        field("udim", udim, Range { kFirstUdim, kLastUdim }, "UDIM tile: what <UDIM> in a name stands for");
        cfem_params.visit(field);
    }
};

/// `hero.lightmap`: exactly one of `environment` and `cfem` must be given.
struct LightmapRecipe
{
    static constexpr const char* kStage = "lightmap";
    std::string vismap, environment, cfem, albedo;
    std::string colorspace, colorconfig, albedo_colorspace;
    LightmapParams lightmap_params;
    /// How the environment is filtered: keys cfem_filter, cfem_order, cfem_resolution, cfem_sanitize.
    CfemParams cfem_params;
    int udim = kFirstUdim;
    /// Whether the tile was said: by the recipe, its name, a query or a flag.
    bool udim_given = false;

    template <class Visit> void visit(Visit&& field)
    {
        field("vismap", vismap, Path {}, "The visibility map, or its recipe");
        field("environment", environment, Path {}, "The lat-long map to be lit by; filtered first");
        field("cfem", cfem, Path {}, "A cosine-filtered environment, or its recipe");
        field("albedo", albedo, Path {}, "Multiply by this texture, converted to scene-linear");
        field("albedo_colorspace", albedo_colorspace, Text {}, "Its colour space, if its name and tags do not tell");
        field("colorspace", colorspace, Text {}, "Colour space of the environment, if its name and tags do not tell");
        field("colorconfig", colorconfig, Path {}, "OCIO config; without it $OCIO");
        field("udim", udim, Range { kFirstUdim, kLastUdim }, "UDIM tile: what <UDIM> in a name stands for");
        lightmap_params.visit(field);
        cfem_params.visit([&](const char* name, auto& value, const auto& allowed, const char* help) {
            field(("cfem_" + std::string(name)).c_str(), value, allowed, help);
        });
    }
};

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
/// As in OIIO the first '?' parts them, '&' parts the overrides, and there is no %-decoding: what holds '&' goes into
/// the file. A key comes once, but for one that takes several names. A file need not exist if there are overrides.
///
/// @param error    set to one line that names file, key and line number, if the result is false
/// @returns false if the file cannot be read, is empty, larger than 1 MiB or not TOML, a key is unknown (the nearest
///          is told) or comes twice, a value is of the wrong type or out of range. Not checked: that the inputs exist.
template <class Recipe> bool read_recipe(Recipe& dst, const std::string& name, std::string& error);
extern template VMLIGHT_API bool read_recipe(VismapRecipe&, const std::string&, std::string&);
extern template VMLIGHT_API bool read_recipe(CfemRecipe&, const std::string&, std::string&);
extern template VMLIGHT_API bool read_recipe(LightmapRecipe&, const std::string&, std::string&);

/// As read_recipe(), from the bytes of a file that would have the name `path`.
template <class Recipe>
bool read_recipe_text(Recipe& dst, OIIO::string_view text, const std::string& path, std::string& error);
extern template VMLIGHT_API bool read_recipe_text(VismapRecipe&, OIIO::string_view, const std::string&, std::string&);
extern template VMLIGHT_API bool read_recipe_text(CfemRecipe&, OIIO::string_view, const std::string&, std::string&);
extern template VMLIGHT_API bool read_recipe_text(LightmapRecipe&, OIIO::string_view, const std::string&, std::string&);

/// The TOML text that read_recipe_text() reads back to the same recipe; only what differs from the defaults, and `udim`
/// if it was given. Paths stand as they are in `recipe`: read_recipe() has resolved them already, but for <UDIM>.
template <class Recipe> std::string recipe_text(const Recipe& recipe);
extern template VMLIGHT_API std::string recipe_text(const VismapRecipe&);
extern template VMLIGHT_API std::string recipe_text(const CfemRecipe&);
extern template VMLIGHT_API std::string recipe_text(const LightmapRecipe&);

/// Which stage's recipe does `name` (a path, with or without ?query) name: "vismap", "cfem", "lightmap"; or "" if its
/// extension is none of these.
VMLIGHT_API std::string recipe_stage(const std::string& name);

/// Does `name` (a path, with or without ?query) have the extension of a recipe: .vismap, .cfem or .lightmap?
VMLIGHT_API bool is_recipe_name(const std::string& name);

/// The file part of a recipe's name: what stands before the first '?'.
VMLIGHT_API std::string recipe_path(const std::string& name);

/// Where a recipe gives a key, to begin a message with: `"hero.lightmap" line 3: albedo`; without a line if it is given
/// after '?', or nowhere. Reads the file again: for messages only.
VMLIGHT_API std::string recipe_place(const std::string& name, const std::string& key);

} // namespace vmlight
