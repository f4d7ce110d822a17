// SPDX-License-Identifier: Apache-2.0
/// Stages from their recipes: read what a recipe names, make what is itself a recipe first, then make the stage.
#pragma once

#include <vmlight/base/export.h>
#include <vmlight/base/progress.h>
#include <vmlight/stage/recipe/recipe.h>

#include <OpenImageIO/imagebuf.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

class BakeScene;

struct MakeOptions
{
    /// Names of the recipes that are being made, outermost first; the last is the one whose struct is given. Empty if
    /// there is no file behind it. Messages name it, and none may be read again.
    std::vector<std::string> chain;
    /// 0 means OIIO's default.
    int threads = 0;
    /// A progress for one step of the work ("bake", "filter", "light"), which makes an image of so many texels.
    std::function<Progress(const std::string& step, int64_t texels)> progress;
    /// One line on what was done, and one on what may surprise.
    std::function<void(const std::string&)> say, warn;
    /// nullptr, or what keeps the mesh and the ray tracer's scene of the last vismap for the next call to share.
    std::shared_ptr<const BakeScene>* scene = nullptr;
    /// The same inputs were made for another UDIM tile before: what is true of all tiles was told.
    bool again = false;
};

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
    /// One, or the levels of a stack; and what they were made from.
    std::vector<OIIO::ImageBuf> cfem;
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
