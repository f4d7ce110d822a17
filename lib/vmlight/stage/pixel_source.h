// SPDX-License-Identifier: Apache-2.0
/// What readers read from: a file, or a recipe whose pixels are made when they are asked for. A recipe's inputs are
/// such sources too, opened here and not through OIIO, so that stages share what they make and never wait for
/// themselves.
#pragma once

#include <vmlight/base/file_stamp.h>
#include <vmlight/stage/recipe/chain.h>

#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace vmlight {

/// An image that is read by region.
class PixelSource
{
public:
    virtual ~PixelSource() = default;

    /// Size, channels and metadata, known before any pixel is.
    const OIIO::ImageSpec& spec() const { return m_spec; }
    /// Images in it: several if it is a stack of CFEM.
    virtual int subimages() const { return 1; }
    virtual const OIIO::ImageSpec& spec_of(int /*subimage*/) const { return m_spec; }
    /// All that the pixels depend on: parameters, and name, size and time of each file. Equal keys, equal pixels.
    const std::string& key() const { return m_key; }

    /// Set `dst` to the float pixels of `roi`, all channels, rows without padding; `roi` lies in the data window. Any
    /// thread. False, with the reason in `error`, if they cannot be made.
    virtual bool read(OIIO::ROI roi, float* dst, std::string& error) = 0;

    /// The same for any image of it.
    virtual bool read_of(int subimage, OIIO::ROI roi, float* dst, std::string& error)
    {
        if (subimage == 0)
            return read(roi, dst, error);
        error = "no such image";
        return false;
    }

    /// Whether what the pixels are made from could not be had, or is no longer as it was, so that another open should
    /// try anew.
    virtual bool failed() const { return false; }
    /// Memory held for later reads, about.
    virtual size_t bytes() const { return 0; }

protected:
    explicit PixelSource(std::string key)
        : m_key(std::move(key))
    {
    }
    OIIO::ImageSpec m_spec;

private:
    const std::string m_key;
};
using PixelSourcePointer = std::shared_ptr<PixelSource>;

/// Open an image by name: a recipe is read and described, any other image is opened by OIIO. Nothing is computed.
/// What is open already, unchanged, is shared.
///
/// @param chain    the recipes that led here
/// @returns nullptr, with the place and reason in `error`, if it cannot be read, an input is missing or not what it
///          should be, or it reads itself
PixelSourcePointer open_source(const std::string& name, std::string& error, const RecipeChain& chain = {});

// The same, for a recipe in memory.
PixelSourcePointer open_source(const VismapRecipe& recipe, std::string& error, const RecipeChain& chain = {});
PixelSourcePointer open_source(const CfemRecipe& recipe, std::string& error, const RecipeChain& chain = {});
PixelSourcePointer open_source(const LightmapRecipe& recipe, std::string& error, const RecipeChain& chain = {});

/// How much the process keeps of what no one has open: 1 GiB in 64 sources unless set.
void set_source_limits(size_t bytes, size_t sources);

// ---- For the rooms of the stages --------------------------------------------------------------------------------

/// Open what `recipe`, the last of `chain`, gives as `key`. nullptr, with the place and reason in `error`, if it cannot
/// be opened or is not `wanted`.
template <class Recipe>
PixelSourcePointer open_input(const Recipe& recipe, const char* key, const std::string& name, Input wanted,
                              std::string& error, const RecipeChain& chain);
extern template PixelSourcePointer open_input(const CfemRecipe&, const char*, const std::string&, Input, std::string&,
                                              const RecipeChain&);
extern template PixelSourcePointer open_input(const LightmapRecipe&, const char*, const std::string&, Input,
                                              std::string&, const RecipeChain&);

/// The source with this key that is open or was lately, or nullptr. Those that failed are forgotten.
PixelSourcePointer find_source(const std::string& key);
/// Remember `source`. Returns the one to use: another thread may have been faster.
PixelSourcePointer keep_source(PixelSourcePointer source);

/// stamp_file() of an OCIO config, "" being $OCIO.
bool stamp_config(std::string& stamp, const std::string& colorconfig, std::string& error);

/// Every parameter of a recipe as text.
template <class Recipe> std::string recipe_key(Recipe recipe)
{
    std::string key = std::string(Recipe::kStage) + "\n";
    recipe.visit([&](const char* name, auto& value, const auto& allowed, const char*) {
        key += std::string(name) + "=" + value_text(value, allowed) + "\n";
    });
    return key;
}

} // namespace vmlight
