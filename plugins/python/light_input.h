// SPDX-License-Identifier: Apache-2.0
/// What a lightmap is made of: files, images in memory, or some of each.
#pragma once

#include "function.h"
#include "image.h"

#include <vmlight/stage/make_stage.h>
#include <vmlight/stage/recipe/recipe.h>

#include <optional>
#include <string>
#include <vector>

namespace vmlight::python {

struct LightmapArguments
{
    LightmapRecipe recipe;
    bool is_cfem = false;

    template <class Visit> void visit(Visit&& field)
    {
        field("is_cfem", is_cfem, Flag {}, "The light is cosine-filtered, though its metadata does not say so");
        recipe.visit(field);
    }
};

/// The operands, by the names `vismap`, `light` and `albedo`; they replace the parameters lightmap_operand_params().
std::vector<Operand> lightmap_operands();
std::vector<std::string> lightmap_operand_params();

class LightInput
{
public:
    /// Throws TypeError and ValueError.
    ///
    /// @param is_kept  whether it is used after the call
    LightInput(const Call& call, const LightmapArguments& given, bool is_kept);

    /// Read and filter what is not in memory yet. False, with the reason in `error`, on failure.
    bool read(const MakeOptions& options, std::string& error);

    /// Light the map, once read() is done. Memory of `dst` that fits is reused.
    bool light(OIIO::ImageBuf& dst, const LightmapParams& params, const MakeOptions& options, std::string& error) const;

    /// The parameters that were given.
    const LightmapParams& params() const { return m_recipe.lightmap_params; }
    /// The files among them, for do_work().
    const std::vector<std::string>& paths() const { return m_paths; }

private:
    bool is_all_files() const { return !m_vismap && !m_light && !m_albedo; }
    bool read_files(const MakeOptions& options, std::string& error);
    bool read_map(const MakeOptions& options, std::string& error);
    bool read_light(const MakeOptions& options, std::string& error);
    bool filter(const OIIO::ImageBuf& environment, bool stack, const MakeOptions& options, std::string& error);
    bool read_albedo(const MakeOptions& options, std::string& error);

    LightmapRecipe m_recipe; // paths of what is a file
    std::optional<Image> m_vismap, m_light, m_albedo; // what is in memory
    std::vector<std::string> m_paths;
    LightmapInputs m_inputs;
};

/// The rotation of `params` must be one. Throws ValueError.
void check_rotation(const LightmapParams& params);

} // namespace vmlight::python
