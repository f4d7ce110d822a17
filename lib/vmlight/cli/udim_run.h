// SPDX-License-Identifier: Apache-2.0
/// UDIM tiles in executables: --udim, --udims and <UDIM> in file names, and the loop over the tiles that they select;
/// for a vismap also <MATERIAL> or <INSTANCE> in -o, and the loop over these parts of the mesh.
#pragma once

#include <vmlight/cli/main.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/stage/recipe/recipe.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace vmlight {

/// Start all messages of `options` with `name`.
void prefix_messages(MakeOptions& options, const std::string& name);

/// The tiles come from --udims, --udim (or the recipe's `udim`), or else <UDIM> in -o, which selects all tiles that
/// exist: for a vismap those that its mesh covers; otherwise those with a file of the first input that contains <UDIM>,
/// or that the mesh covers if that input is a vismap recipe.
template <class Recipe> class UdimRun
{
public:
    /// Adds the flags and checks to `stage`; call it before the stage's own flags are added. Both must outlive this.
    UdimRun(StageMain& stage, Recipe& recipe);

    /// Which of these flags cannot be saved in a recipe, or "": see StageMain::recipe().
    std::string unsavable() const { return m_udims.empty() ? "" : "--udims cannot be saved in a recipe"; }

    /// Makes one tile, `recipe` with its udim, and writes it to `output`.
    using Make = std::function<bool(const Recipe& recipe, const std::string& output, const MakeOptions& options,
                                    std::string& error)>;
    /// Call `make` for each material or instance in the file's order, and for each of its tiles in ascending order; its
    /// messages are prefixed with its name and the tile's number. Stops at the first failure: returns false, with these
    /// and the reason in `error`. Files of earlier tiles stay.
    bool make_tiles(const Make& make, std::string& error);

private:
    struct Input
    {
        std::string key, name;
    };
    /// What is made of one material or instance, or of all.
    struct Part
    {
        Recipe recipe;
        std::string name, output; // as its messages start, "" for all; with <UDIM>
        std::vector<int> udims;
    };
    std::vector<Input> inputs() const;
    bool is_single_tile() const
    {
        const bool are_all = m_stage.output().empty() ? !inputs().empty() : has_udim_pattern(m_stage.output());
        return m_udims.empty() && (m_recipe.udim_given || !are_all);
    }
    std::string fault();
    std::string mesh_part_fault() const;
    std::string find_tiles_by_files();
    bool find_tiles(Part& dst, const MakeOptions& options, std::string& error) const;
    bool find_parts(std::vector<Part>& dst, const MakeOptions& options, std::string& error) const;
    bool make_part(const Part& part, const Make& make, const MakeOptions& options, std::string& error) const;

    StageMain& m_stage;
    Recipe& m_recipe;
    bool m_udim_flag = false;
    std::vector<int> m_udims; // from --udims
    std::vector<int> m_tiles; // to make; empty if they depend on a mesh
    std::string m_vismap; // the recipe whose mesh they depend on; "" for m_recipe
};

#define VMLIGHT_INSTANTIATE(Recipe) extern template class UdimRun<Recipe>;
VMLIGHT_RECIPES(VMLIGHT_INSTANTIATE)
#undef VMLIGHT_INSTANTIATE

} // namespace vmlight
