// SPDX-License-Identifier: Apache-2.0
/// What executables share about UDIM tiles: --udim, --udims and <UDIM> in names; which tiles that means; and one tile
/// made after the other.
#pragma once

#include <vmlight/cli/main.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/stage/recipe/recipe.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace vmlight {

/// One of --udims, --udim (or the recipe's own `udim`), and <UDIM> in -o tells the tiles. <UDIM> in -o alone asks for
/// all there are: for a vismap those that its mesh reaches; else those for which there are files of the first input
/// that holds <UDIM>, or that the mesh reaches if that is the recipe of a vismap.
template <class Recipe> class UdimRun
{
public:
    /// Gives `stage` the flags and the checks of the command line; before the stage's other flags. Both must outlive
    /// this.
    UdimRun(StageMain& stage, Recipe& recipe);

    /// What of this a recipe cannot hold, for StageMain::recipe().
    std::string unsaid() const { return m_udims.empty() ? "" : "a recipe holds no --udims"; }

    /// Makes and writes one tile: `recipe` with its udim, to `output`. Reads one tile's images at a time.
    using Make = std::function<bool(const Recipe& recipe, const std::string& output, const MakeOptions& options,
                                    std::string& error)>;
    /// Call `make` for each tile, ascending; what it says goes with the tile's number. False, with the tile and the
    /// reason in `error`, at the first that fails; the files of those before it stay.
    bool each(const Make& make, std::string& error);

private:
    struct Input
    {
        std::string key, name;
    };
    std::vector<Input> inputs() const;
    bool is_one() const { return m_udims.empty() && (m_recipe.udim_given || !has_udim_pattern(m_stage.output())); }
    std::string fault();
    std::string find_files();
    bool find_tiles(const MakeOptions& options, std::string& error);

    StageMain& m_stage;
    Recipe& m_recipe;
    bool m_flag = false;
    std::vector<int> m_udims; // of --udims
    std::vector<int> m_tiles; // to make; none before find_tiles() if only a mesh can tell
    std::string m_vismap; // the recipe whose mesh tells; "" is this one's
};

#define VMLIGHT_INSTANTIATE(Recipe) extern template class UdimRun<Recipe>;
VMLIGHT_RECIPES(VMLIGHT_INSTANTIATE)
#undef VMLIGHT_INSTANTIATE

} // namespace vmlight
