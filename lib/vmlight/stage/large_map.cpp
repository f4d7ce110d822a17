// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/large_map.h>

#include <vmlight/base/format.h>
#include <vmlight/stage/recipe/strand_recipe.h>
#include <vmlight/vismap/band_baker.h>
#include <vmlight/vismap/basis.h>
#include <vmlight/vismap/margin_rows.h>
#include <vmlight/vismap/reconstruct.h>

namespace vmlight {
namespace {

// Smaller maps are baked whole, which is simpler: beside the rest of the process they matter little.
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
    return MarginRows::is_narrow(params.margin) && whole_bytes(describe_vismap("", params), params) > kLargeBytes
        && !options.poses && !bakes_strands(recipe);
}

double map_bytes(const VismapRecipe& recipe, const MakeOptions& options)
{
    const OIIO::ImageSpec spec = describe_vismap("", recipe.vismap_params);
    return is_large_map(recipe, options) ? BandBaker::held_bytes(recipe.vismap_params, spec.nchannels, options.threads)
                                         : whole_bytes(spec, recipe.vismap_params);
}

MapFile::MapFile(const std::string& path, const FileParams& params)
    : m_path(path)
    , m_params(params)
    , m_output(path, params)
{
}

MapRows MapFile::rows(const Progress& progress)
{
    const auto begin = [this](OIIO::ImageSpec& spec, std::string& error) {
        const std::string fault = m_params.format == "half" ? half_fault(spec) : "";
        if (!fault.empty()) {
            error = format("\"{}\": {}", m_path, fault);
            return false;
        }
        return m_output.open({ spec }, error);
    };
    const auto take = [this, progress](int ybegin, int yend, const float* texels, std::string& error) {
        if (progress && !progress(0)) {
            error = format("\"{}\": interrupted", m_path);
            return false;
        }
        return m_output.write_rows(ybegin, yend, texels, error);
    };
    return { begin, take };
}

bool write_large_map(const VismapRecipe& recipe, const std::string& path, const FileParams& file,
                     const MakeOptions& options, std::string& error)
{
    error = output_fault(path); // before the work
    MapFile output(path, file);
    return error.empty() && stream_vismap(output.rows(), recipe, options, error) && output.commit(error);
}

} // namespace vmlight
