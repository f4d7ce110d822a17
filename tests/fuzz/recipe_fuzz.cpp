// SPDX-License-Identifier: Apache-2.0
// Any bytes as a recipe: refused in one line, or read to what its own text reads back to.
//   recipe_fuzz -max_total_time=60 NEW_CORPUS tests/fuzz/recipe_corpus
#include "law.h"

#include <vmlight/stage/recipe/recipe.h>

#include <cstdint>

using namespace vmlight::fuzz;

namespace {

template <class Recipe> void try_text(OIIO::string_view text)
{
    Recipe recipe, back;
    std::string error;
    if (!vmlight::read_recipe_text(recipe, text, "folder/x", error)) {
        return require_reason(error);
    }
    require(error.empty(), "what is read has no fault", error);
    const std::string said = vmlight::recipe_text(recipe);
    require(vmlight::read_recipe_text(back, said, "x", error), "what is written can be read", said + error);
    require(vmlight::recipe_text(back) == said, "what is written reads back to the same", said);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    const OIIO::string_view text(reinterpret_cast<const char*>(data), size);
    try_text<vmlight::VismapRecipe>(text);
    try_text<vmlight::CfemRecipe>(text);
    try_text<vmlight::LightmapRecipe>(text);
    return 0;
}
