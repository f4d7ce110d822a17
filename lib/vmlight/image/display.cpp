// SPDX-License-Identifier: Apache-2.0
#include <vmlight/image/display.h>

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/image/color_conversion.h>
#include <vmlight/image/color_space.h>

#include <OpenImageIO/color.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imagebufalgo_util.h>
#include <OpenImageIO/strutil.h>
#include <OpenImageIO/sysutil.h>

#include <algorithm>
#include <vector>

namespace vmlight {
namespace {

using OIIO::ColorConfig;

// `asked`, which must be one of `names`, or `fallback` if it is empty.
bool choose(std::string& dst, const std::string& asked, const std::string& fallback,
            const std::vector<std::string>& names, const char* what, std::string& error)
{
    dst = asked.empty() ? fallback : asked;
    if (std::find(names.begin(), names.end(), dst) != names.end())
        return true;
    error = format("the OCIO config has no {} \"{}\"; it has {}", what, dst, OIIO::Strutil::join(names, ", "));
    return false;
}

OIIO::ColorProcessorHandle find_processor(const DisplayParams& params, const std::string& space,
                                          const std::string& config_name, std::string& note, std::string& error)
{
    const auto config = open_color_config(config_name, error);
    if (!config)
        return nullptr;
    std::string display, view;
    if (!choose(display, params.display, config->getDefaultDisplayName(), config->getDisplayNames(), "display", error)
        || !choose(view, params.view, config->getDefaultViewName(display), config->getViewNames(display), "view",
                   error))
        return nullptr;
    const SourceSpace named = source_named(*config, space);
    const std::string from
        = named.found() && !named.unlisted ? named.name : config->getColorSpaceNameByRole("scene_linear");
    note = format("display: {}, view: {}", display, view) + (params.look.empty() ? "" : ", look: " + params.look);
    auto processor = config->createDisplayTransform(display, view, from, params.look);
    if (!processor)
        error = format("OCIO: {}", oiio::error_line(*config));
    return processor;
}

// Divide R, G, B by alpha.
void unmultiply(OIIO::ImageBuf& image)
{
    if (image.spec().alpha_channel >= 0)
        OIIO::ImageBufAlgo::unpremult(image, image);
}

} // namespace

bool show_on_display(OIIO::ImageBuf& image, const DisplayParams& params, const std::string& space,
                     const std::string& config, int nthreads, std::string& note, std::string& error)
{
    std::string name = config;
    if (name.empty())
        name = OIIO::Sysutil::getenv("OCIO");
    const OIIO::ROI color(image.roi().xbegin, image.roi().xend, image.roi().ybegin, image.roi().yend, 0, 1, 0, 3);
    if (name.empty()) {
        if (!params.display.empty() || !params.view.empty() || !params.look.empty()) {
            error = "displays, views and looks need an OCIO config: set --colorconfig or $OCIO";
            return false;
        }
        unmultiply(image);
        note = "display: sRGB (no OCIO config)";
        OIIO::ImageBufAlgo::parallel_image(color, nthreads, [&](OIIO::ROI roi) {
            for (OIIO::ImageBuf::Iterator<float> pixel(image, roi); !pixel.done(); ++pixel)
                for (int c = 0; c < 3; ++c)
                    pixel[c] = std::clamp(OIIO::linear_to_sRGB(float(pixel[c])), 0.0f, 1.0f);
        });
        return true;
    }
    const auto processor = find_processor(params, space, name, note, error);
    if (!processor)
        return false;
    unmultiply(image);
    if (!OIIO::ImageBufAlgo::colorconvert(image, image, processor.get(), false, color, nthreads)
        || !OIIO::ImageBufAlgo::clamp(image, image, 0.0f, 1.0f, false, color, nthreads)) {
        error = oiio::error_line(image);
        return false;
    }
    return true;
}

void show_numbers(OIIO::ImageBuf& image)
{
    unmultiply(image);
    OIIO::ROI color = image.roi();
    color.chend = 3;
    OIIO::ImageBufAlgo::clamp(image, image, 0.0f, 1.0f, false, color);
}

} // namespace vmlight
