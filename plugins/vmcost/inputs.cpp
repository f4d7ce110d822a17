// SPDX-License-Identifier: Apache-2.0
#include "inputs.h"

#include "compare.h"
#include "journal.h"
#include "named_channels.h"
#include "sweep.h"

#include <vmlight/base/format.h>
#include <vmlight/base/interrupt.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/image/channels.h>
#include <vmlight/image/image_file.h>
#include <vmlight/reference/reference.h>
#include <vmlight/stage/environment_file.h>
#include <vmlight/stage/scene_cache.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/strutil.h>

#include <cmath>
#include <set>

namespace vmlight::cost {
namespace {

// Fewer are not representative.
constexpr int64_t kMinTexels = 2 * kBatches;

std::string unique_name(const std::string& path, std::set<std::string>& taken)
{
    const std::string file = OIIO::Filesystem::filename(path);
    const std::string stem = file.substr(0, file.size() - OIIO::Filesystem::extension(file).size());
    std::string name = stem;
    for (int i = 2; !taken.insert(name).second; ++i)
        name = format("{}_{}", stem, i);
    return name;
}

// The windows and channels are part of it: equal pixels in another window are different light.
std::string environment_hash(const OIIO::ImageBuf& image)
{
    const OIIO::ImageSpec& spec = image.spec();
    return OIIO::ImageBufAlgo::computePixelHashSHA1(
        image,
        format("{}x{} {} {} of {}x{} {} {} border {} channels {}", spec.width, spec.height, spec.x, spec.y,
               spec.full_width, spec.full_height, spec.full_x, spec.full_y, spec.get_int_attribute("oiio:sampleborder"),
               OIIO::Strutil::join(spec.channelnames, ",")));
}

bool read_environment(Environment& dst, CfemRecipe light, const MakeOptions& options, std::string& error)
{
    light.environment = dst.path;
    std::string note;
    if (!vmlight::read_environment(dst.image, light, options, note, error))
        return false;
    dst.hash = environment_hash(dst.image);
    options.say(format("{}: {}x{}, {}", dst.name, dst.image.spec().width, dst.image.spec().height, note));
    return true;
}

ReferenceParams reference_params(const CostParams& params)
{
    ReferenceParams reference;
    reference.samples = params.pairs();
    reference.seed = params.seed;
    reference.sanitize = params.sanitize;
    return reference;
}

bool trace(Environment& environment, const Inputs& inputs, const CostParams& params, const std::string& path,
           int nthreads, const Progress& progress, std::string& error)
{
    const VismapParams map = reference_map(params);
    if (!make_reference(environment.reference, *inputs.scene, environment.image, map, {}, reference_params(params),
                        nthreads, progress)) {
        const std::string reason = oiio::error_line(environment.reference);
        error = reason == "interrupted" ? reason : format("\"{}\": {}", environment.path, reason);
        return false;
    }
    const DeferInterrupts writing;
    return write_image(environment.reference, path, {}, {}, error);
}

} // namespace

std::string Inputs::scene_text() const
{
    return scene->mesh_hash() + "\n" + scene->occluder_hashes() + "\n";
}

bool read_inputs(Inputs& dst, const VismapRecipe& mesh, const std::vector<std::string>& environments,
                 const CfemRecipe& light, const MakeOptions& options, std::string& error)
{
    SceneStamps stamps;
    std::string at;
    if (!stamp_scene(stamps, mesh, at, error)
        || !share_scene(dst.scene, mesh, stamps, options.threads, nullptr, at, error))
        return false;
    std::set<std::string> taken;
    for (const std::string& path : environments) {
        Environment& environment = dst.environments.emplace_back();
        environment.path = path;
        environment.name = unique_name(path, taken);
        if (!read_environment(environment, light, options, error))
            return false;
    }
    return true;
}

VismapParams reference_map(const CostParams& params)
{
    VismapParams map;
    map.resolution = { params.side(), params.side() };
    params.set_scene(map);
    return map;
}

bool trace_references(Inputs& inputs, const CostParams& params, const std::string& folder, const MakeOptions& options,
                      WholeProgress& progress, std::string& error)
{
    for (Environment& environment : inputs.environments) {
        ReferenceParams reference = reference_params(params);
        std::string text = format("reference\n{}{}\n{}\n", inputs.scene_text(), environment.hash, params.side());
        reference.visit([&](const char* name, auto& value, const auto& allowed, const char*) {
            text += format("{}={}\n", name, value_text(value, allowed));
        });
        if (params.ground || std::isfinite(params.max_distance))
            text += format("ground={} {} {}\n", params.ground, params.ground_height, params.max_distance);
        environment.reference_key = hash_key(text);
        const std::string path
            = format("{}/reference_{}_{}.exr", folder, environment.name, environment.reference_key.substr(0, 12));
        std::string ignored;
        const bool kept
            = OIIO::Filesystem::exists(path) && read_channels(environment.reference, path, kReferenceChannels, ignored);
        const bool reused = kept
            && environment.reference.roi()
                == OIIO::ROI(0, params.side(), 0, params.side(), 0, 1, 0, int(kReferenceChannels.size()));
        const double weight = reference_weight(params.pairs());
        if (reused) {
            options.say(format("{}: reused the reference", environment.name));
            progress.skip(weight);
        } else if (!trace(environment, inputs, params, path, options.threads, progress.part(weight), error)) {
            return false;
        }
        const int64_t covered = covered_texels(environment.reference);
        if (covered < kMinTexels)
            error = format("the mesh covers {} of {}x{} texels; at least {} are needed: raise --resolution", covered,
                           params.side(), params.side(), kMinTexels);
        else if (const int lit = lit_batches(environment.reference); lit < 2)
            error = format("\"{}\": {}", environment.path,
                           lit ? "light reaches too few texels to estimate an error: raise --resolution"
                               : "no light reaches the mesh");
        if (!error.empty())
            return false;
    }
    return true;
}

} // namespace vmlight::cost
