// SPDX-License-Identifier: Apache-2.0
/// Whole stages from their recipes. A recipe is opened as the readers open it (pixel_source.h), then made at once, by
/// all threads.
#pragma once

#include <vmlight/base/export.h>
#include <vmlight/stage/make_options.h>
#include <vmlight/stage/recipe/recipe.h>

#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight {

/// Make a stage.
///
/// @param dst      set to the image, as make_vismap(), make_cfem() and make_lightmap() make it; a vismap's metadata
///                 hold the parameters of its mesh too
/// @returns false, with the reason in `dst.geterror()`, if an input is missing, cannot be read or made, or is not what
///          it should be (with the recipe's line, if that says it), or if a recipe reads itself through others.
VMLIGHT_API bool make_image(OIIO::ImageBuf& dst, const VismapRecipe& recipe, const MakeOptions& options = {});
VMLIGHT_API bool make_image(OIIO::ImageBuf& dst, const CfemRecipe& recipe, const MakeOptions& options = {});
VMLIGHT_API bool make_image(OIIO::ImageBuf& dst, const LightmapRecipe& recipe, const MakeOptions& options = {});

/// As make_image(), all levels if `recipe` asks for a stack; of which make_image() makes the first alone. False, with
/// the reason in `error`.
VMLIGHT_API bool make_images(std::vector<OIIO::ImageBuf>& dst, const CfemRecipe& recipe, const MakeOptions& options,
                             std::string& error);

/// The UDIM tiles that the mesh of `recipe` reaches, see mesh_udims(). Reads the mesh: with `options.scene` it is there
/// when it is baked. False, with the reason in `error`, if it cannot be read or baked, or reaches none.
VMLIGHT_API bool vismap_udims(std::vector<int>& dst, const VismapRecipe& recipe, const MakeOptions& options,
                              std::string& error);

/// What a lightmap reads, ready for make_lightmap(): for several lightmaps of the same inputs.
struct LightmapInputs
{
    OIIO::ImageBuf vismap, albedo;
    /// The images that the model reads: a CFEM, the lobes of a stack, or the environment itself.
    std::vector<OIIO::ImageBuf> cfem;
    /// Identifies the file or recipe of `cfem`, and which of its images these are.
    std::string light;

    /// nullptr if the recipe has none.
    const OIIO::ImageBuf* albedo_or_none() const { return albedo.initialized() ? &albedo : nullptr; }
};

/// Read or make what `recipe` names; the light of `dst` stays if it is that of `recipe`. False, with the reason in
/// `error`, as for make_image().
VMLIGHT_API bool read_lightmap_inputs(LightmapInputs& dst, const LightmapRecipe& recipe, const MakeOptions& options,
                                      std::string& error);

/// The stage that an image is: by its name if that is a recipe's, else by the `vmlight:stage` of the file. "" if it is
/// none or cannot be opened. Pixels are not read.
VMLIGHT_API std::string image_stage(const std::string& name);

} // namespace vmlight
