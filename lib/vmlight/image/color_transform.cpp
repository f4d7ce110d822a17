// SPDX-License-Identifier: Apache-2.0
#include <vmlight/image/color_transform.h>

#include <vmlight/base/format.h>
#include <vmlight/base/params.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/image/color_conversion.h>
#include <vmlight/image/color_labels.h>
#include <vmlight/image/color_space.h>
#include <vmlight/image/primaries.h>

#include <OpenImageIO/color.h>
#include <OpenImageIO/strutil.h>
#include <OpenImageIO/sysutil.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace vmlight {

using OIIO::ColorConfig;

namespace {

SourceSpace space_asked_for(const ColorConfig& config, const std::string& config_name, const std::string& asked,
                            std::string& error)
{
    const SourceSpace space = source_named(config, asked);
    if (!space.found()) {
        const std::string near = nearest_name(asked, all_space_names(config));
        error = format("OCIO config \"{}\" has no colour space \"{}\"", config_name, asked);
        error += near.empty() ? "; it has " + OIIO::Strutil::join(config.getColorSpaceNames(), ", ")
                              : "; did you mean \"" + near + "\"?";
    }
    return space;
}

// In the order of docs/pipeline.md, "Which colour space an image is in".
bool find_source(SourceSpace& from, std::vector<std::string>& warnings, const ColorConfig& config,
                 const ColorLabels& labels, const std::string& path, const std::string& config_name,
                 const ColorSettings& settings, std::string& error)
{
    if (!settings.from.empty()) {
        from = space_asked_for(config, config_name, settings.from, error);
        return from.found();
    }
    const SourceSpace label = source_named(config, labels.interop_id);
    const SourceSpace primaries = labels.primaries ? linear_source(config, *labels.primaries) : SourceSpace {};
    const PathSpace by_path = settings.labels_only ? PathSpace {} : space_of_path(config, path);
    const SourceSpace ruled = by_path.space.empty() ? SourceSpace {} : source_named(config, by_path.space);
    if (!label.found() && !labels.interop_id.empty())
        warnings.push_back(
            format("its colorInteropID \"{}\" is not a colour space of OCIO config \"{}\" and is ignored",
                   labels.interop_id, config_name));
    if (ruled.found() && by_path.by_name) {
        from = ruled;
        const SourceSpace& own = label.found() ? label : primaries;
        if (own.found() && id_of(config, own) != id_of(config, from))
            warnings.push_back(format("its name says {}, but its {} {}: taken as {}", from.name,
                                      label.found() ? "colorInteropID says" : "chromaticities are those of", own.name,
                                      from.name));
        return true;
    }
    if (label.found() || primaries.found()) {
        from = label.found() ? label : primaries;
        from.reason = label.found() ? "" : " by its chromaticities";
        add_contradiction(warnings, labels, from.name);
        return check_label(labels, path, error);
    }
    if (!labels.unknown_primaries.empty())
        warnings.push_back(unknown_primaries_text(labels));
    from = ruled;
    return true;
}

bool find_with_config(ColorTransform& transform, const ColorLabels& labels, const std::string& path,
                      const std::string& config_name, const ColorSettings& settings, std::string& error)
{
    const auto opened = open_color_config(config_name, error);
    if (!opened)
        return false;
    ColorConfig& config = *opened;
    SourceSpace from;
    if (!find_source(from, transform.warnings, config, labels, path, config_name, settings, error))
        return false;
    const std::string working = config.getColorSpaceNameByRole("scene_linear");
    if (!from.found() && is_integer(settings.stored)) {
        from = { first_space_named(config, kSrgbNames) };
        if (!from.found()) {
            error = format("\"{}\": integer pixels are taken as sRGB, but OCIO config \"{}\" has no colour space {}; "
                           "specify the image's colour space",
                           path, config_name, kSrgb);
            return false;
        }
    }
    if (!from.found())
        from = { working };

    transform.space = interop_id_of(config, working);
    if (from.is_data || (!from.unlisted && is_data_space(config, from.name))) {
        transform.note = format("{} is data, used as {} unchanged", from.name, working);
        return true;
    }
    transform.note = from.name + from.reason + (from.name == working ? std::string(", unchanged") : " -> " + working);
    return conversion_between(transform.convert, config, config_name, from, { working }, error);
}

void srgb_to_linear(float* rgb, int count)
{
    work_counts().pixels_converted += count;
    std::transform(rgb, rgb + 3 * size_t(count), rgb, [](float x) { return OIIO::sRGB_to_linear(x); });
}

bool find_without_config(ColorTransform& transform, const ColorLabels& labels, const std::string& path,
                         const ColorSettings& settings, std::string& error)
{
    // OIIO's built-in config differs between versions: do not use it.
    const std::vector<std::string> srgb { kSrgbNames.begin(), kSrgbNames.end() }, data { "data", "raw" };
    std::vector<std::string> linear_ids;
    for (const LinearSpace& space : linear_spaces())
        linear_ids.emplace_back(space.interop_id);
    const LinearSpace& rec709 = *linear_space_named(kLinearRec709);
    // Names such as ACEScg are a config's: their spelling and meaning are up to it.
    const auto linear = [&](const std::string& name) {
        const LinearSpace* space = linear_space_named(name);
        return is_any_of(name, { "linear" })                  ? &rec709
            : space == &rec709 || is_any_of(name, linear_ids) ? space
                                                              : nullptr;
    };
    const std::string& asked = settings.from;
    std::string from = asked, reason;
    if (!asked.empty() && !is_any_of(asked, srgb) && !is_any_of(asked, data) && !linear(asked)) {
        error = format("colour space \"{}\" needs an OCIO config: set --colorconfig or $OCIO; without one only {}, "
                       "data and {} are known",
                       asked, kSrgb, OIIO::Strutil::join(linear_ids, ", "));
        return false;
    }
    const std::string& id = labels.interop_id;
    if (asked.empty() && (!id.empty() || labels.primaries)
        && (!is_integer(settings.stored) || is_any_of(id, data) || linear(id))) {
        from = id.empty() ? labels.primaries->interop_id : id;
        reason = id.empty() ? " by its chromaticities" : "";
        add_contradiction(transform.warnings, labels, from);
        if (!check_label(labels, path, error))
            return false;
    } else if (asked.empty() && !labels.unknown_primaries.empty()) {
        transform.warnings.push_back(unknown_primaries_text(labels));
    }
    if (from.empty())
        from = is_integer(settings.stored) ? kSrgb : kLinearRec709;

    const LinearSpace* named = linear_space_named(settings.working);
    const LinearSpace& working = named ? *named : rec709;
    transform.space = working.interop_id;
    const LinearSpace* source = is_any_of(from, srgb) ? &rec709 : linear(from);
    if (is_any_of(from, data)) {
        transform.note = format("data, used as {} unchanged (no OCIO config)", working.interop_id);
        return true;
    }
    if (!source) {
        // Tagged with a space that needs a config: keep pixels and tag.
        transform.space = from;
        transform.note = format("{}, unchanged (no OCIO config)", from);
        return true;
    }
    if (source != &working)
        transform.convert = matrix_conversion(*source, working);
    if (is_any_of(from, srgb))
        transform.convert = one_after_the_other(srgb_to_linear, transform.convert);
    transform.note = (is_any_of(from, srgb) ? kSrgb : source->interop_id) + reason
        + (transform.convert ? format(" -> {}", working.interop_id) : ", unchanged") + " (no OCIO config)";
    return true;
}

// A curve would make light of values that are not light.
bool is_linear(const ColorConversion& convert)
{
    if (!convert)
        return true;
    const std::array<float, 3> least { 0.25f, 0.5f, 0.125f };
    std::array<float, 3> once = least, many;
    std::transform(least.begin(), least.end(), many.begin(), [](float x) { return 16 * x; });
    convert(once.data(), 1);
    convert(many.data(), 1);
    return std::equal(once.begin(), once.end(), many.begin(),
                      [](float a, float b) { return std::abs(16 * a - b) <= 1e-3f * std::abs(b); });
}

bool find_output_with_config(ColorTransform& transform, const std::string& working, const std::string& config_name,
                             const std::string& asked, std::string& error)
{
    const auto opened = open_color_config(config_name, error);
    if (!opened)
        return false;
    ColorConfig& config = *opened;
    const SourceSpace to = space_asked_for(config, config_name, asked, error);
    SourceSpace from = source_named(config, working);
    if (!from.found())
        from = { config.getColorSpaceNameByRole("scene_linear") };
    if (!to.found() || !conversion_between(transform.convert, config, config_name, from, to, error))
        return false;
    transform.space = id_of(config, to);
    transform.note = from.name + " -> " + to.name;
    if (!to.is_data && is_linear(transform.convert))
        return true;
    error = format(
        "output_colorspace: \"{}\" is {}, but light is scene-linear; convert the image with oiiotool afterwards", asked,
        to.is_data ? "data" : "not linear");
    return false;
}

bool find_output_without_config(ColorTransform& transform, const std::string& working, const std::string& asked,
                                std::string& error)
{
    const LinearSpace* to = linear_space_named(asked);
    const LinearSpace* from = linear_space_named(working.empty() ? kLinearRec709 : working);
    if (!to || !from) {
        error = to
            ? format("the light's own colour space, \"{}\", needs an OCIO config: set --colorconfig or $OCIO", working)
            : format("output_colorspace: \"{}\" needs an OCIO config: set --colorconfig or $OCIO; without one only "
                     "the interop ids of linear spaces are known, such as {}",
                     asked, kLinearRec709);
        return false;
    }
    if (from != to)
        transform.convert = matrix_conversion(*from, *to);
    transform.space = to->interop_id;
    transform.note = format("{} -> {} (no OCIO config)", from->interop_id, to->interop_id);
    return true;
}

std::string config_of(const ColorSettings& settings)
{
    return settings.config.empty() ? std::string(OIIO::Sysutil::getenv("OCIO")) : settings.config;
}

} // namespace

bool find_color_transform(ColorTransform& transform, const OIIO::ImageSpec& spec, const std::string& path,
                          const ColorSettings& settings, std::string& error)
{
    const std::string config = config_of(settings);
    const ColorLabels labels = read_color_labels(spec, settings.stored);
    error.clear();
    const bool found = config.empty() ? find_without_config(transform, labels, path, settings, error)
                                      : find_with_config(transform, labels, path, config, settings, error);
    for (std::string& warning : transform.warnings)
        warning = format("\"{}\": {}; --colorspace (--albedo-colorspace) decides", path, warning);
    return found;
}

bool find_output_transform(ColorTransform& transform, const std::string& working, const std::string& asked,
                           const ColorSettings& settings, std::string& error)
{
    const std::string config = config_of(settings);
    return config.empty() ? find_output_without_config(transform, working, asked, error)
                          : find_output_with_config(transform, working, config, asked, error);
}

} // namespace vmlight
