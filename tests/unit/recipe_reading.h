// SPDX-License-Identifier: Apache-2.0
/// Recipes read from texts and by name, or refused: for the tests of the recipe rooms.
#pragma once

#include <vmlight/stage/recipe/recipe.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace vmlight {

/// "KEY=VALUE" of each parameter.
template <class Recipe> std::vector<std::string> values(Recipe recipe)
{
    std::vector<std::string> texts;
    recipe.visit([&](const char* name, auto& value, const auto& allowed, const char*) {
        texts.push_back(std::string(name) + "=" + value_text(value, allowed));
    });
    return texts;
}

template <class Recipe = LightmapRecipe>
Recipe parsed(const std::string& text, const std::string& path = "hero.lightmap")
{
    Recipe recipe;
    std::string error;
    EXPECT_TRUE(read_recipe_text(recipe, text, path, error)) << error;
    return recipe;
}

/// What is said of a text that is not a recipe; the recipe must be as it was.
template <class Recipe = LightmapRecipe> std::string refusal(const std::string& text)
{
    Recipe recipe;
    std::string error;
    EXPECT_FALSE(read_recipe_text(recipe, text, "hero.lightmap", error)) << text;
    EXPECT_EQ(values(recipe), values(Recipe {})) << text;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    return error;
}

/// The same of a file's name, with its query.
template <class Recipe = LightmapRecipe> std::string name_refusal(const std::string& name)
{
    Recipe recipe;
    std::string error;
    EXPECT_FALSE(read_recipe(recipe, name, error)) << name;
    EXPECT_EQ(values(recipe), values(Recipe {})) << name;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    return error;
}

} // namespace vmlight
