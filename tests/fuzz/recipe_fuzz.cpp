// SPDX-License-Identifier: Apache-2.0
// Any bytes as a recipe: refused in one line, or read to what its own text reads back to.
//   recipe_fuzz -max_total_time=60 NEW_CORPUS tests/fuzz/recipe_corpus
#include <vmlight/recipe.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace {

void require(bool good, const char* law, const std::string& seen)
{
    if (good)
        return;
    std::fprintf(stderr, "%s: %s\n", law, seen.c_str());
    std::abort();
}

template <class Recipe> void try_text(OIIO::string_view text)
{
    Recipe recipe, back;
    std::string error;
    if (!vmlight::read_recipe_text(recipe, text, "folder/x", error)) {
        require(!error.empty(), "a refusal has a reason", error);
        require(error.find_first_of(std::string("\n\r\0", 3)) == std::string::npos, "a reason is one line", error);
        return;
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
