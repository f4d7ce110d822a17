// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cfem/stack.h>

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/cfem/exact.h>
#include <vmlight/cfem/one_color.h>
#include <vmlight/cfem/radiance.h>
#include <vmlight/cfem/rows.h>
#include <vmlight/cfem/spherical_harmonics.h>

namespace vmlight {
namespace {

// Bands of the projection. The errors in the header include what is cut off beyond them.
constexpr int kOrder = 32;

// Progress of one step, as a share of the whole.
Progress share(const Progress& progress, double from, double to)
{
    if (!progress)
        return {};
    return [=](double done) { return progress(from + (to - from) * done); };
}

} // namespace

double power_lobe_eigenvalue(int l, double s)
{
    double value = l % 2 == 0 ? 1 : (s + 1) / (s + 2);
    for (int k = l % 2; k < l; k += 2)
        value *= (s - k) / (s + k + 3);
    return value;
}

OIIO::ImageSpec describe_cfem_level(const OIIO::ImageSpec& env, const CfemParams& params, int level)
{
    OIIO::ImageSpec spec = describe_cfem(env, params);
    spec.attribute("vmlight:stack", "true");
    spec.attribute("vmlight:lobe", float(stack_lobe(level)));
    // EXR requires a unique name for each of several images.
    spec.attribute("oiio:subimagename", format("lobe{:.4f}", stack_lobe(level)));
    return spec;
}

bool make_cfem_stack(std::vector<OIIO::ImageBuf>& dst, const Environment& env, const CfemParams& params,
                     std::string& error, int nthreads, const Progress& progress)
{
    OIIO::ImageBuf radiance;
    std::vector<OIIO::ImageBuf> images;
    dst.clear();
    if (!make_lobes(images, env, params, error, nthreads, share(progress, 0, 0.95))
        || !make_radiance(radiance, env, params, error, share(progress, 0.95, 1)))
        return false;
    dst = std::move(images);
    dst.push_back(std::move(radiance));
    return true;
}

bool make_lobes(std::vector<OIIO::ImageBuf>& dst, const Environment& env, const CfemParams& params, std::string& error,
                int nthreads, const Progress& progress)
{
    dst.clear();
    std::vector<OIIO::ImageBuf> levels(kStackLevels);
    if (!make_cfem(levels[0], env, params, nthreads, share(progress, 0, 0.5))) {
        error = oiio::error_line(levels[0]);
        return false;
    }
    const int sanitized = levels[0].spec().get_int_attribute("vmlight:sanitized");
    levels[0].specmod() = describe_cfem_level(env.spec(), params, 0);
    record_sanitized(levels[0].specmod(), sanitized);

    const std::optional<OneColor> color = find_one_color(env, params.sanitize);
    const bool skip = color && params.skip_one_color;
    const auto filter = [&](auto&& work) {
        EnvironmentRows rows(env, params.sanitize);
        const ReadRow read = [&](int row, float* pixels) { return rows.read(row, pixels); };
        if (rows.open() && work(rows.grid(), read))
            return true;
        error = rows.error().empty() ? "interrupted" : rows.error();
        return false;
    };
    const auto keep = [&](int level, std::vector<double>& rgb) {
        if (color)
            fill(rgb, params.resolution, *color);
        OIIO::ImageSpec spec = describe_cfem_level(env.spec(), params, level);
        record_sanitized(spec, sanitized);
        return set_filtered(levels[size_t(level)], spec, rgb, true, error);
    };
    std::vector<double> rgb, coefficients;
    if (!skip && !filter([&](const EnvironmentGrid& grid, const ReadRow& read) {
            return filter_exact(rgb, params.resolution, grid, read, nthreads, share(progress, 0.5, 0.7),
                                HemisphereWeight::uniform);
        }))
        return false;
    if (!keep(1, rgb))
        return false;
    if (!skip && !filter([&](const EnvironmentGrid& grid, const ReadRow& read) {
            return project_harmonics(coefficients, kOrder, grid, read, nthreads, share(progress, 0.7, 1));
        }))
        return false;
    for (int level = 2; level < kStackLevels; ++level) {
        if (!skip) {
            const double s = power_lobe_exponent(stack_lobe(level));
            std::vector<double> scaled = coefficients;
            for (int l = 0; l < kOrder; ++l)
                for (int i = 3 * l * l; i < 3 * (l + 1) * (l + 1); ++i)
                    scaled[size_t(i)] *= power_lobe_eigenvalue(l, s);
            evaluate_harmonics(rgb, params.resolution, scaled, kOrder, nthreads);
        }
        if (!keep(level, rgb))
            return false;
    }
    dst = std::move(levels);
    return true;
}

bool is_stack(OIIO::cspan<OIIO::ImageBuf> levels)
{
    return levels.size() > 1 && levels[0].spec().get_string_attribute("vmlight:stack") == "true";
}

} // namespace vmlight
