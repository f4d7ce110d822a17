// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/udim_run.h>

#include <vmlight/base/format.h>
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

void name_tile(MakeOptions& options, int udim)
{
    const std::string tile = format("tile {}: ", udim);
    options.say = [tile, say = options.say](const std::string& line) { say(tile + line); };
    options.warn = [tile, warn = options.warn](const std::string& line) { warn(tile + line); };
    options.progress = [tile, progress = options.progress](const std::string& step, int64_t texels) {
        return progress(tile + step, texels);
    };
}

} // namespace

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

// What is wrong with the command line, or "". Sets the tiles, unless they depend on a mesh.
template <class Recipe> std::string UdimRun<Recipe>::fault()
{
    const std::string& output = m_stage.output();
    const std::vector<Input> patterns = inputs();
    if (m_udim_flag && !m_udims.empty())
        return "give only one of udim and udims";
    if (!m_udims.empty() && !has_udim_pattern(output) && patterns.empty())
        return "udims: no file name contains <UDIM>";
    if (m_udims.size() > 1 && !has_udim_pattern(output))
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

template <class Recipe> bool UdimRun<Recipe>::find_tiles(const MakeOptions& options, std::string& error)
{
    if (!m_tiles.empty())
        return true;
    VismapRecipe recipe;
    MakeOptions inner = options;
    if constexpr (std::is_same_v<Recipe, VismapRecipe>)
        recipe = m_recipe;
    else if (const std::string name = udim_path(m_vismap, kFirstUdim); read_recipe(recipe, name, error))
        inner.chain.push_back(name);
    else
        return false;
    if (!has_udim_pattern(recipe.mesh))
        return vismap_udims(m_tiles, recipe, inner, error);
    m_tiles = existing_udims(recipe.mesh);
    if (m_tiles.empty())
        error = format("\"{}\": mesh: \"{}\": no files match", m_vismap, recipe.mesh);
    return !m_tiles.empty();
}

template <class Recipe> bool UdimRun<Recipe>::make_tiles(const Make& make, std::string& error)
{
    std::shared_ptr<const BakeScene> scene; // shared by all tiles of a mesh
    MakeOptions options = m_stage.make_options();
    options.scene = &scene;
    if (!find_tiles(options, error))
        return false;
    const bool named = !is_single_tile() || m_recipe.udim_given;
    for (const int udim : m_tiles) {
        error = output_fault(udim_path(m_stage.output(), udim));
        if (!error.empty())
            return false;
    }
    for (const int udim : m_tiles) {
        Recipe recipe = m_recipe;
        MakeOptions tile = options;
        udim_of(recipe) = udim;
        recipe.udim_given = named;
        tile.repeated_inputs = udim != m_tiles.front();
        if (named)
            name_tile(tile, udim);
        if (!make(recipe, udim_path(m_stage.output(), udim), tile, error)) {
            if (named)
                error = format("tile {}: {}", udim, error);
            return false;
        }
    }
    return true;
}

#define VMLIGHT_INSTANTIATE(Recipe) template class UdimRun<Recipe>;
VMLIGHT_RECIPES(VMLIGHT_INSTANTIATE)
#undef VMLIGHT_INSTANTIATE

} // namespace vmlight
