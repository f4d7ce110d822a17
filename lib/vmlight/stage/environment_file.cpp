// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/environment_file.h>

#include <vmlight/base/format.h>
#include <vmlight/image/channels.h>
#include <vmlight/image/color.h>
#include <vmlight/image/color_labels.h>
#include <vmlight/image/radiance_header.h>
#include <vmlight/stage/layer_source.h>
#include <vmlight/stage/open_source.h>

#include <algorithm>
#include <array>
#include <cstdlib>

namespace vmlight {
namespace {

struct Shape
{
    int wide, high;
    const char* name;
};
constexpr int kLeastShape = 32; // pixels of the longer side
constexpr Shape kOtherShapes[] { { 6, 1, "a cube map's six faces in a row" },
                                 { 1, 6, "a cube map's six faces in a column" },
                                 { 4, 3, "a cube map's cross" },
                                 { 3, 4, "a cube map's vertical cross" },
                                 { 1, 1, "a light probe or a single face" } };

std::string layout_fault(int width, int height)
{
    if (std::max(width, height) < kLeastShape)
        return "";
    for (const Shape& shape : kOtherShapes)
        if (int64_t(width) * shape.high == int64_t(height) * shape.wide)
            return format("{}x{} pixels is the shape of {}, and an environment must be lat-long, twice as wide as "
                          "high; convert it, or set --layout latlong",
                          width, height, shape.name);
    return "";
}

} // namespace

bool check_environment(const OIIO::ImageSpec& spec, const CfemRecipe& recipe, std::string& error)
{
    const std::string& path = recipe.environment;
    std::array<int, 3> channels;
    if (!find_color_channels(spec, channels, error)) {
        error = format("\"{}\": {}{}", path, error, layer_advice(path, "--layer"));
        return false;
    }
    const std::string fault = recipe.layout == "auto" ? layout_fault(spec.full_width, spec.full_height) : "";
    error = fault.empty() ? "" : format("\"{}\": {}", path, fault);
    return fault.empty();
}

void report_doubts(const std::string& path, const OIIO::ImageSpec& spec, OIIO::TypeDesc stored,
                   const MakeOptions& options)
{
    if (std::abs(spec.full_width - 2 * spec.full_height) > 2) // sample borders add one pixel each way
        options.report_warning(format("\"{}\" is {}x{}, not twice as wide as high: treated as a lat-long map anyway",
                                      path, spec.full_width, spec.full_height));
    const std::string stage = spec.get_string_attribute("vmlight:stage");
    if (stage == kCfemStage)
        options.report_warning(format("\"{}\": filtered already (its vmlight:stage is \"{}\") and filtered again; give "
                                      "makelightmap this file, or makecfem the environment itself",
                                      path, stage));
    else if (!stage.empty())
        options.report_warning(
            format("\"{}\": its vmlight:stage is \"{}\"; filtered as an environment anyway", path, stage));
    if (is_integer(stored))
        options.report_warning(format("\"{}\": {} bit, no light above 1: shadows will be weak; use an EXR or HDR", path,
                                      8 * stored.basesize()));
    const std::string radiance = unapplied_radiance_header(path);
    if (!radiance.empty())
        options.report(format("\"{}\": {}", path, radiance));
}

bool read_environment(OIIO::ImageBuf& dst, const CfemRecipe& recipe, const MakeOptions& options, std::string& note,
                      std::string& error)
{
    const PixelSourcePointer file
        = open_input(recipe, "environment", recipe.environment, InputKind::Environment, error, {}, recipe.layer);
    std::vector<OIIO::ImageBuf> images;
    if (!file || !check_environment(file->spec(), recipe, error) || !file->make(images, {}, options, error))
        return false;
    dst = std::move(images[0]);
    const OIIO::TypeDesc stored = file->spec().format;
    report_doubts(recipe.environment, dst.spec(), stored, options);
    std::vector<std::string> warnings;
    if (!to_scene_linear(dst, recipe.environment, { recipe.colorconfig, recipe.colorspace, stored }, note, error,
                         options.threads, &warnings))
        return false;
    for (const std::string& warning : warnings)
        options.report_warning(warning);
    return true;
}

} // namespace vmlight
