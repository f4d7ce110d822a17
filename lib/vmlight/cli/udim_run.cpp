// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/udim_run.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/cli/mesh_part_names.h>
#include <vmlight/image/image_file.h>
#include <vmlight/stage/recipe/udim.h>
#include <vmlight/uv/udim.h>

#include <OpenImageIO/strutil.h>

#include <memory>

namespace vmlight {
namespace {

// Parameters that name inputs, in the order in which they determine the tiles.
constexpr const char* kInputs[] = { "mesh", "occluder", "vismap", "albedo", "environment", "cfem", "colorconfig" };

bool is_vismap_recipe(const std::string& name)
{
    return recipe_stage(name) == VismapRecipe::kStage;
}

} // namespace

void prefix_messages(MakeOptions& options, const std::string& name)
{
    options.say = [name, say = options.say](const std::string& line) { say(name + line); };
    options.answer = [name, answer = options.answer](const std::string& line) { answer(name + line); };
    options.warn = [name, warn = options.warn](const std::string& line) { warn(name + line); };
    options.progress = [name, progress = options.progress](const std::string& step, int64_t texels) {
        return progress(name + step, texels);
    };
}

template <class Recipe>
UdimRun<Recipe>::UdimRun(StageMain& stage, Recipe& recipe)
    : m_stage(stage)
    , m_recipe(recipe)
{
    stage.group("UDIM tiles:");
    stage.option("udim", format("{}..{}", kFirstUdim, kLastUdim), "Tile to make; replaces <UDIM> in file names [1001]",
                 [&](OIIO::string_view text, std::string& error) {
                     m_udim_flag = recipe.udim_given = true;
                     return set_param(recipe, "udim", text, error);
                 });
    stage.option("udims", "LIST", "Tiles to make, such as 1001-1003,1011, with <UDIM> in -o [all that exist]",
                 [&](OIIO::string_view text, std::string& error) {
                     if (parse_udims(m_udims, std::string(text), error))
                         return true;
                     error = "udims: " + error;
                     return false;
                 });
    stage.check([&] { return fault(); });
}

template <class Recipe> auto UdimRun<Recipe>::inputs() const -> std::vector<Input>
{
    std::vector<Input> found;
    for (const char* key : kInputs)
        for (const std::string& name : OIIO::Strutil::splits(recipe_value(m_recipe, key), "\n"))
            if (has_udim_pattern(name))
                found.push_back({ key, name });
    return found;
}

template <class Recipe> std::string UdimRun<Recipe>::mesh_part_fault() const
{
    const std::string& output = m_stage.output();
    const MeshPartPattern* const pattern = mesh_part_pattern(output);
    if (!pattern)
        return "";
    if (mesh_part_pattern(mesh_part_path(output, *pattern, "")))
        return format("\"{}\": give one of {}, and choose among the other by its flag", output,
                      mesh_part_pattern_list());
    if constexpr (std::is_same_v<Recipe, VismapRecipe>)
        return has_udim_pattern(m_recipe.mesh) && !is_single_tile()
            ? format("\"{}\": {} needs one mesh for all tiles, or --udim; \"{}\" is one for each", output,
                     pattern->text, m_recipe.mesh)
            : "";
    return format("\"{}\": {} is for visibility maps: only makevismap knows the {} of a mesh", output, pattern->text,
                  pattern->nouns);
}

// What is wrong with the command line, or "". Sets the tiles, unless they depend on a mesh.
template <class Recipe> std::string UdimRun<Recipe>::fault()
{
    const std::string& output = m_stage.output();
    const std::vector<Input> patterns = inputs();
    if (const std::string reason = mesh_part_fault(); !reason.empty())
        return reason;
    if (m_udim_flag && !m_udims.empty())
        return "give only one of --udim and --udims";
    if (!m_udims.empty() && !has_udim_pattern(output) && patterns.empty())
        return "udims: no file name contains <UDIM>";
    if (m_udims.size() > 1 && !output.empty() && !has_udim_pattern(output))
        return format("\"{}\": {} tiles need <UDIM> in the file name, for the number", output, m_udims.size());
    if (is_single_tile() && !m_recipe.udim_given && !patterns.empty())
        return format("{}: \"{}\": which tile? Pass --udim, or <UDIM> in -o for all", patterns[0].key,
                      patterns[0].name);
    m_tiles = m_udims;
    if (is_single_tile())
        m_tiles = { udim_of(m_recipe) };
    if constexpr (std::is_same_v<Recipe, LightmapRecipe>)
        if (m_tiles.size() != 1 && is_vismap_recipe(m_recipe.vismap) && !has_udim_pattern(m_recipe.vismap))
            return format("vismap: \"{}\" is a single tile; did you mean \"{}{}udim=<UDIM>\"?", m_recipe.vismap,
                          m_recipe.vismap, recipe_path(m_recipe.vismap) == m_recipe.vismap ? "?" : "&");
    if (!std::is_same_v<Recipe, VismapRecipe> && m_tiles.size() > 1 && patterns.empty())
        return "udims: no input contains <UDIM>: all tiles would be identical";
    return m_tiles.empty() ? find_tiles_by_files() : "";
}

template <class Recipe> std::string UdimRun<Recipe>::find_tiles_by_files()
{
    for (const Input& input : inputs()) {
        const bool is_recipe = is_recipe_name(input.name);
        const std::string pattern = is_recipe ? recipe_path(input.name) : input.name;
        if (input.key == "occluder")
            continue; // the mesh determines the tiles
        if (has_udim_pattern(pattern)) {
            m_tiles = existing_udims(pattern);
            return m_tiles.empty() ? format("{}: \"{}\": no files match", input.key, pattern) : "";
        }
        if (input.key == "vismap" && is_vismap_recipe(input.name)) {
            m_vismap = input.name;
            return "";
        }
    }
    if (std::is_same_v<Recipe, VismapRecipe>)
        return "";
    return format("\"{}\": which tiles? No input contains <UDIM>: pass --udim or --udims", m_stage.output());
}

template <class Recipe>
bool UdimRun<Recipe>::find_tiles(Part& dst, const MakeOptions& options, std::string& error) const
{
    dst.udims = m_tiles;
    if (!dst.udims.empty())
        return true;
    VismapRecipe recipe;
    MakeOptions inner = options;
    if constexpr (std::is_same_v<Recipe, VismapRecipe>)
        recipe = dst.recipe;
    else if (const std::string name = udim_path(m_vismap, kFirstUdim); read_recipe(recipe, name, error))
        inner.chain.push_back(name);
    else
        return false;
    if (!has_udim_pattern(recipe.mesh))
        return vismap_udims(dst.udims, recipe, inner, error);
    dst.udims = existing_udims(recipe.mesh);
    if (dst.udims.empty())
        error = format("\"{}\": mesh: \"{}\": no files match", m_vismap, recipe.mesh);
    return !dst.udims.empty();
}

template <class Recipe>
bool UdimRun<Recipe>::find_parts(std::vector<Part>& dst, const MakeOptions& options, std::string& error) const
{
    const MeshPartPattern* const pattern = mesh_part_pattern(m_stage.output());
    if (!pattern)
        dst.push_back({ m_recipe, "", m_stage.output(), {} });
    if constexpr (std::is_same_v<Recipe, VismapRecipe>)
        if (pattern) {
            std::vector<std::string> names;
            if (!pattern->find(names, m_recipe, options, error))
                return false;
            error = same_file_fault(*pattern, names);
            if (!error.empty()) {
                error = format("\"{}\": {}", m_recipe.mesh, error);
                return false;
            }
            for (const std::string& name : names) {
                Part& part = dst.emplace_back();
                part.recipe = m_recipe;
                part.name = format("{} {}: ", pattern->noun, printable_line(name));
                part.output = mesh_part_path(m_stage.output(), *pattern, name);
                part.recipe.selection.*pattern->selection = { name };
            }
        }
    for (Part& part : dst) {
        if (!find_tiles(part, options, error))
            return false;
        for (const int udim : part.udims) {
            error = part.output.empty() ? "" : output_fault(udim_path(part.output, udim));
            if (!error.empty())
                return false;
        }
    }
    return true;
}

template <class Recipe>
bool UdimRun<Recipe>::make_part(const Part& part, const Make& make, const MakeOptions& options,
                                std::string& error) const
{
    const bool named = !is_single_tile() || m_recipe.udim_given;
    for (const int udim : part.udims) {
        Recipe recipe = part.recipe;
        MakeOptions tile = options;
        udim_of(recipe) = udim;
        recipe.udim_given = named;
        tile.repeated_inputs = udim != part.udims.front();
        std::string name = part.name;
        if (named)
            name += format("tile {}: ", udim);
        if (!name.empty())
            prefix_messages(tile, name);
        if (!make(recipe, udim_path(part.output, udim), tile, error)) {
            error = name + error;
            return false;
        }
    }
    return true;
}

template <class Recipe> bool UdimRun<Recipe>::make_tiles(const Make& make, std::string& error)
{
    std::shared_ptr<const BakeScene> scene; // shared by all tiles of a mesh
    MakeOptions options = m_stage.make_options();
    options.scene = &scene;
    std::vector<Part> parts;
    if (!find_parts(parts, options, error))
        return false;
    const std::shared_ptr<const BakeScene> whole = scene; // shared by all parts
    for (const Part& part : parts) {
        options.repeated_mesh = &part != &parts.front();
        if (!make_part(part, make, options, error))
            return false;
    }
    return true;
}

#define VMLIGHT_INSTANTIATE(Recipe) template class UdimRun<Recipe>;
VMLIGHT_RECIPES(VMLIGHT_INSTANTIATE)
#undef VMLIGHT_INSTANTIATE

} // namespace vmlight
