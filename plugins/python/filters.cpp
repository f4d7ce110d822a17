// SPDX-License-Identifier: Apache-2.0
/// make_cfem().
#include "function.h"
#include "image.h"
#include "mesh_input.h"
#include "recipe_input.h"
#include "stages.h"
#include "work.h"

#include <vmlight/base/oiio_compat.h>
#include <vmlight/cfem/cfem.h>
#include <vmlight/cfem/stack.h>
#include <vmlight/stage/make_stage.h>

namespace vmlight::python {
namespace {

const char* const kCfem
    = "Filter a lat-long environment with the cosine: the diffuse light C(n) of each direction n, as radiance.\n\n"
      "A file is brought to the scene-linear working space, as makecfem does, and gives the same bytes. An image in "
      "memory\nmust be linear; what concerns files is refused.";

Image filter_file(const Call& call, CfemRecipe recipe, const std::string& path)
{
    recipe.environment = path;
    check_recipe(recipe, call);
    std::vector<OIIO::ImageBuf> images;
    do_work(call.work, { path }, [&](const MakeOptions& options, std::string& error) {
        return make_images(images, recipe, options, error);
    });
    return own(std::move(images));
}

Image filter_image(const Call& call, const CfemRecipe& recipe)
{
    std::vector<std::string> names = param_names(CfemParams());
    names.insert(names.end(), { "stack", "kernel" });
    allow_only(call, names, "an environment that is a file");
    check_unused(recipe, call);
    const Image environment = input_image("environment", call.operands[0]);
    std::vector<OIIO::ImageBuf> images;
    do_work(call.work, {}, [&](const MakeOptions& options, std::string& error) {
        const CfemParams& params = recipe.cfem_params;
        const Progress progress = options.step("filter", params.resolution.width, params.resolution.height);
        if (recipe.stack)
            return make_cfem_stack(images, environment.first(), params, error, options.threads, progress);
        if (make_cfem(images.emplace_back(), environment.first(), params, options.threads, progress))
            return true;
        error = oiio::error_line(images[0]);
        return false;
    });
    return own(std::move(images));
}

} // namespace

void define_filters(py::module_& m)
{
    const Signature<CfemRecipe> signature(
        { "make_cfem",
          FunctionKind::function,
          kCfem,
          { { "environment", "StrPath | Image | NDArray | ImageBuf", "A lat-long map" } },
          "Image",
          "R, G, B as float32; with stack, its images are in subimages, and this is the first of them" },
        { "environment" });
    m.def(
        "make_cfem",
        [signature](const py::args& args, const py::kwargs& kwargs) {
            const auto [call, recipe] = signature.read(args, kwargs);
            const py::object& environment = call.operands[0];
            return is_path(environment) ? filter_file(call, recipe, path_text("environment", environment))
                                        : filter_image(call, recipe);
        },
        docstring(signature.function()).c_str());
    add_to_table("make_cfem", signature.function());
}

} // namespace vmlight::python
