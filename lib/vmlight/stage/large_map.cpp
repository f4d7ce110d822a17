// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/large_map.h>

#include <vmlight/base/format.h>
#include <vmlight/image/exr_output.h>
#include <vmlight/stage/recipe/strand_recipe.h>
#include <vmlight/vismap/band_baker.h>
#include <vmlight/vismap/basis.h>
#include <vmlight/vismap/reconstruct.h>

#include <optional>

namespace vmlight {
namespace {

// Smaller maps are baked whole: beside the rest of the process it matters little, and no texel beyond a seam is traced
// twice.
constexpr double kLargeBytes = double(1 << 30);

double whole_bytes(const OIIO::ImageSpec& spec, const VismapParams& params)
{
    // The map, and what the file's writer holds of it.
    return 1.5 * double(spec.image_pixels()) * spec.nchannels * sizeof(float) + reconstruct_bytes(params);
}

} // namespace

bool is_large_map(const VismapRecipe& recipe, const MakeOptions& options)
{
    const VismapParams& params = recipe.vismap_params;
    return BandBaker::can_fill(params.margin) && whole_bytes(describe_vismap("", params), params) > kLargeBytes
        && !options.poses && !bakes_strands(recipe);
}

double map_bytes(const VismapRecipe& recipe, const MakeOptions& options)
{
    const OIIO::ImageSpec spec = describe_vismap("", recipe.vismap_params);
    return is_large_map(recipe, options) ? BandBaker::held_bytes(recipe.vismap_params, spec.nchannels, options.threads)
                                         : whole_bytes(spec, recipe.vismap_params);
}

bool write_large_map(const VismapRecipe& recipe, const std::string& path, const FileParams& file,
                     const MakeOptions& options, std::string& error)
{
    error = output_fault(path); // before the work
    if (!error.empty())
        return false;
    ExrOutput output(path, file);
    const auto begin = [&](OIIO::ImageSpec& spec, std::string& reason) {
        const std::string fault = file.format == "half" ? half_fault(spec) : "";
        if (!fault.empty()) {
            reason = format("\"{}\": {}", path, fault);
            return false;
        }
        return output.open({ spec }, reason);
    };
    const auto take = [&](int ybegin, int yend, const float* texels, std::string& reason) {
        return output.write_rows(ybegin, yend, texels, reason);
    };
    return stream_vismap({ begin, take }, recipe, options, error) && output.commit(error);
}

} // namespace vmlight
