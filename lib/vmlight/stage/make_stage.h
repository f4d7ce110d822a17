// SPDX-License-Identifier: Apache-2.0
/// Whole stages from their recipes: opened as the readers open them (pixel_source.h), then made on all threads.
#pragma once

#include <vmlight/base/export.h>
#include <vmlight/stage/make_options.h>
#include <vmlight/stage/recipe/recipe.h>

#include <OpenImageIO/imagebuf.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// Make a stage.
///
/// @param dst      set to the image, as make_vismap(), make_cfem() and make_lightmap() make it; the metadata of a
///                 vismap also include the parameters of its mesh
/// @returns false, with the reason in `dst.geterror()` (and the recipe's line, where that sets the input), if an input
///          is missing, cannot be read or made, or is of the wrong kind, or if a recipe reads itself through others.
VMLIGHT_API bool make_image(OIIO::ImageBuf& dst, const VismapRecipe& recipe, const MakeOptions& options = {});
VMLIGHT_API bool make_image(OIIO::ImageBuf& dst, const CfemRecipe& recipe, const MakeOptions& options = {});
VMLIGHT_API bool make_image(OIIO::ImageBuf& dst, const LightmapRecipe& recipe, const MakeOptions& options = {});

/// Like make_image(), but all images of a stack if `recipe` asks for one; make_image() returns the first only. False,
/// with the reason in `error`, on failure.
VMLIGHT_API bool make_images(std::vector<OIIO::ImageBuf>& dst, const CfemRecipe& recipe, const MakeOptions& options,
                             std::string& error);

/// Report which effects a bake would simulate, why, and the time and memory that it would take; bakes some texels only.
/// False, with the reason in `error`, as for make_image().
VMLIGHT_API bool forecast_vismap(const VismapRecipe& recipe, const MakeOptions& options, std::string& error);

/// The UDIM tiles that what `recipe` bakes of its mesh covers, see mesh_udims(). Reads the mesh; with `options.scene` a
/// later bake shares it. False, with the reason in `error`, if the mesh cannot be read or baked, or covers no tile.
VMLIGHT_API bool vismap_udims(std::vector<int>& dst, const VismapRecipe& recipe, const MakeOptions& options,
                              std::string& error);

/// The names of the materials that `recipe` bakes, see baked_materials(). Reads the mesh as vismap_udims() does. False,
/// with the reason in `error`, if the mesh cannot be read or baked, or has no materials.
VMLIGHT_API bool vismap_materials(std::vector<std::string>& dst, const VismapRecipe& recipe, const MakeOptions& options,
                                  std::string& error);

/// The names of the instances that `recipe` bakes, see baked_instances(). Otherwise as vismap_materials().
VMLIGHT_API bool vismap_instances(std::vector<std::string>& dst, const VismapRecipe& recipe, const MakeOptions& options,
                                  std::string& error);

struct LightmapSuns;
class BounceShading;

/// The inputs of a lightmap, ready for make_lightmap(), so that several lightmaps can share them.
struct LightmapInputs
{
    OIIO::ImageBuf vismap, albedo;
    /// The images that the model reads: a CFEM, the lobes of a stack, or the environment itself.
    std::vector<OIIO::ImageBuf> cfem;
    /// Identify the files or recipes of `vismap`, `albedo` and `cfem`; of the last also which of its images these are.
    std::string map, texture, light;
    /// The suns that `cfem` was split into, and where their shadows are traced; nullptr if the recipe's suns are off.
    std::shared_ptr<LightmapSuns> suns;
    /// The surfaces that light bounces off; nullptr if the recipe asks for none, or has no albedo.
    std::shared_ptr<BounceShading> bounce;
    /// How their colours are converted: conversions_of().
    std::function<std::string()> color;
    /// Brings what make_lightmap() makes of these to the output_colorspace of the recipe.
    std::function<void(OIIO::ImageBuf& lightmap)> finish;

    /// The albedo, or nullptr if the recipe has none.
    const OIIO::ImageBuf* albedo_or_none() const { return albedo.initialized() ? &albedo : nullptr; }
};

/// Read or make the inputs of `recipe`, keeping what `dst` has if it is the same. False, with the reason in
/// `error`, as for make_image().
VMLIGHT_API bool read_lightmap_inputs(LightmapInputs& dst, const LightmapRecipe& recipe, const MakeOptions& options,
                                      std::string& error);

/// Light `inputs`, with their suns, and bring the result to the output_colorspace of their recipe. False, with the
/// reason in `error`, as make_lightmap() or if the suns cannot be traced.
VMLIGHT_API bool make_lightmap(OIIO::ImageBuf& dst, const LightmapInputs& inputs, const LightmapParams& params,
                               const MakeOptions& options, std::string& error);

/// The stage of an image: from its name if it is a recipe, else from `vmlight:stage` in the file. "" if it is not a
/// stage or cannot be opened. Reads no pixels.
VMLIGHT_API std::string image_stage(const std::string& name);

} // namespace vmlight
