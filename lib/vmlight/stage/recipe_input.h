// SPDX-License-Identifier: Apache-2.0
/// The images that a recipe names: read, or made if the name is a recipe's.
#pragma once

#include <vmlight/stage/make_stage.h>
#include <vmlight/stage/recipe/chain.h>

#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight {

/// Read or make the image `name`, which `recipe` gives as `key`. Recurses through make_image() where that is a recipe.
///
/// @param wanted   what it must be
/// @param options  whose chain ends with `recipe`
/// @param levels   nullptr, or what takes all images of a stack; `dst` is then left without pixels
/// @returns false, with the reason and its place in `error`, if it cannot be read or made, is not what is wanted, or a
///          recipe reads itself through others. Not checked: its channels.
template <class Recipe>
bool read_input(OIIO::ImageBuf& dst, const Recipe& recipe, const char* key, const std::string& name, Input wanted,
                const MakeOptions& options, std::string& error, std::vector<OIIO::ImageBuf>* levels = nullptr);

} // namespace vmlight
