// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cfem/cfem.h>

#include <vmlight/base/available_memory.h>
#include <vmlight/base/fail_with.h>
#include <vmlight/base/format.h>
#include <vmlight/cfem/filter_kernel.h>
#include <vmlight/cfem/one_color.h>
#include <vmlight/cfem/rows.h>
#include <vmlight/cfem/spherical_harmonics.h>
#include <vmlight/image/channels.h>
#include <vmlight/version.h>

#include <OpenImageIO/filesystem.h>

#include <vector>

namespace vmlight {

OIIO::ImageSpec describe_cfem(const OIIO::ImageSpec& env, const CfemParams& params)
{
    OIIO::ImageSpec spec(params.resolution.width, params.resolution.height, 3, OIIO::TypeFloat);
    spec.channelnames = { "R", "G", "B" };
    spec.attribute("vmlight:stage", kCfemStage);
    spec.attribute("vmlight:version", VMLIGHT_VERSION_STRING);
    append_params(spec, params);
    if (params.kernel != kCosineKernel) // a map of surfaces has the metadata that it always had
        spec.attribute(metadata_name("kernel"), params.kernel);
    spec.attribute("oiio:updirection", "y");
    for (const char* name : { "colorInteropID", "chromaticities" })
        if (const OIIO::ParamValue* value = env.find_attribute(name))
            spec.extra_attribs.add_or_replace(*value);
    return spec;
}

void record_environment(OIIO::ImageSpec& cfem, const std::string& image)
{
    // A '?' starts a plugin's query, or is part of a file's name.
    const std::string path = OIIO::Filesystem::exists(image) ? image : image.substr(0, image.find('?'));
    cfem.attribute("vmlight:environment", OIIO::Filesystem::filename(path));
}

bool make_cfem(OIIO::ImageBuf& dst, const Environment& env, const CfemParams& params, int nthreads,
               const Progress& progress)
{
    std::string error;
    if (!check_params(params, error))
        return fail_with(dst, error);
    const FilterKernel* const kernel = find_filter_kernel(params.kernel);
    if (!kernel)
        return fail_with(dst, format("kernel: \"{}\" is not {}", params.kernel, allowed_text(kernel_choices())));
    error = memory_shortage(describe_cfem(env.spec(), params));
    if (!error.empty())
        return fail_with(dst, error);
    EnvironmentRows rows(env, params.sanitize);
    if (!rows.open())
        return fail_with(dst, rows.error());

    const std::optional<OneColor> color = find_one_color(env, params.sanitize);
    std::vector<double> rgb;
    const ReadRow read = [&](int row, float* pixels) { return rows.read(row, pixels); };
    const bool exact = params.filter == "exact";
    const bool skip = color && params.skip_one_color;
    const bool done = skip ? !progress || progress(1)
                           : (exact ? kernel->filter(rgb, params.resolution, rows.grid(), read, nthreads, progress)
                                    : filter_harmonics(rgb, params.resolution, params.order, rows.grid(), read,
                                                       nthreads, progress, kernel->eigenvalue));
    if (!done)
        return fail_with(dst, rows.error().empty() ? "interrupted" : rows.error());
    if (color)
        fill(rgb, params.resolution, *color);

    OIIO::ImageSpec spec = describe_cfem(env.spec(), params);
    record_sanitized(spec, color ? color->repaired : rows.bad_values());
    // An exact sum is below 0 by rounding alone; the ringing of harmonics is kept.
    return set_filtered(dst, spec, rgb, exact, error) || fail_with(dst, error);
}

} // namespace vmlight
