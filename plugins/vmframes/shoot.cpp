// SPDX-License-Identifier: Apache-2.0
#include "shoot.h"

#include "comparison.h"
#include "film.h"
#include "keep.h"
#include "shot.h"

#include <vmlight/base/format.h>
#include <vmlight/base/frames.h>
#include <vmlight/base/text_format.h>
#include <vmlight/image/image_file.h>
#include <vmlight/image/picture_file.h>
#include <vmlight/lightmap/light_level.h>

#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

namespace vmlight::frames {
namespace {

using OIIO::ImageBuf;

constexpr int kSheetWidth = 2048;

// Multiply colour and light by 2^stops.
void expose(ImageBuf& image, double stops)
{
    if (stops == 0)
        return;
    const float factor = float(std::exp2(stops));
    const OIIO::ImageSpec& spec = image.spec();
    std::vector<float> factors(size_t(spec.nchannels), 1.0f);
    for (int c = 0; c < spec.nchannels; ++c) {
        const std::string& name = spec.channelnames[size_t(c)];
        if (c < 3 || OIIO::Strutil::starts_with(name, "lit."))
            factors[size_t(c)] = factor;
    }
    OIIO::ImageBufAlgo::mul(image, image, factors);
}

class Shooting
{
public:
    Shooting(const Request& request, StageMain& stage)
        : m_request(request)
        , m_stage(stage)
        , m_options(stage.make_options())
        , m_shot(request)
        , m_models(request.models())
    {
        // What holds for all frames is said once; what is wrong with the file of one of them, then.
        const auto said = std::make_shared<std::set<std::string>>();
        m_options.warn = [said, warn = m_options.warn](const std::string& line) {
            if (said->insert(line).second)
                warn(line);
        };
    }

    bool run(std::string& error)
    {
        m_options.explain = m_request.explains;
        error = m_request.missing_fault();
        if (!error.empty() || !check_display(error) || !m_shot.open(m_options, error) || !find_exposure(error))
            return false;
        for (size_t i = 0; i < m_request.frames.size(); ++i) {
            ImageBuf frame;
            if (!make_frame(frame, i, error) || !finish_frame(frame, i, error))
                return false;
            if (i == 0)
                m_options.say = [](const std::string&) {}, m_options.explain = false; // the rest say nothing new
        }
        const double frames = double(m_request.frames.size());
        m_stage.say(format("render: {} of {}x{}; a frame took {:.3f} s to light and {:.3f} s to render",
                           count_text(int64_t(m_request.frames.size()), "frame", "frames"), m_request.render.size.width,
                           m_request.render.size.height, m_shot.light_seconds() / frames,
                           m_shot.render_seconds() / frames));
        return write_films(error) && (m_request.sheet.keep.empty() || keep_maps(m_shot, m_request, error));
    }

private:
    // Whether the display, view and look are there, before the work.
    bool check_display(std::string& error) const
    {
        ImageBuf pixel(OIIO::ImageSpec(1, 1, 3, OIIO::TypeFloat));
        OIIO::ImageBufAlgo::zero(pixel);
        std::string note;
        const bool is_shown = !is_exr_name(m_request.output) || !m_request.sheet.contact_sheet.empty();
        return !is_shown || show_on_display(pixel, m_request.display, "", m_request.filter.colorconfig, 1, note, error);
    }

    bool find_exposure(std::string& error)
    {
        m_stops = m_request.light.exposure;
        if (m_request.environment.empty())
            return true;
        double mean = 0;
        if (!m_shot.measure(mean, 0, m_models[0], m_options, error))
            return false;
        if (m_models[0] == "auto" && !m_shot.used_model().empty())
            m_options.report(format("model: {}, the best that this visibility map supports", m_shot.used_model()));
        const GrayExposure gray = GrayExposure::of(mean);
        if (!m_request.is_auto_exposed) {
            m_options.report(mean > 0 ? format("light: mean luminance {:.3g}; {}", mean, gray.advice())
                                      : std::string("light: no texel is lit"));
            return true;
        }
        m_stops = gray.stops;
        if (!(mean > 0))
            m_options.report_warning("--exposure auto: no light in the first frame, so 0 stops for all");
        else if (!gray.is_gray)
            m_options.report_warning("--exposure auto: " + gray.advice());
        m_options.report(format("exposure: {:.2f} stops, for all frames", m_stops));
        return true;
    }

    // All models of a frame, combined.
    bool make_frame(ImageBuf& dst, size_t index, std::string& error)
    {
        std::vector<ImageBuf> images;
        RenderParams params = m_request.render;
        // Comparisons are of what objects cover.
        const bool wants_coverage
            = std::find(params.layers.begin(), params.layers.end(), kCoverageLayer) != params.layers.end();
        if (m_models.size() > 1 && !wants_coverage)
            params.layers.emplace_back(kCoverageLayer);
        for (const std::string& model : m_models) {
            if (!m_shot.render(images.emplace_back(), index, model, params, m_options, error))
                return false;
            expose(images.back(), m_stops);
        }
        if (images.size() == 1) {
            dst = std::move(images[0]);
        } else {
            const std::string text = rms_text(images);
            if (!wants_coverage)
                for (ImageBuf& image : images)
                    image = OIIO::ImageBufAlgo::channels(image, image.nchannels() - 1, {});
            m_stage.say(format("frame {}: {}", m_request.frames[index], text));
            dst = m_request.sheet.wipe.empty() ? side_by_side(images) : wipe(images[0], images[1]);
            dst.specmod().attribute("vmlight:compared", text);
        }
        dst.specmod().attribute("vmlight:exposure", float(m_stops));
        return true;
    }

    // Against the last, or against the reference if that is one of them.
    std::string rms_text(const std::vector<ImageBuf>& images) const
    {
        const auto reference = std::find(m_models.begin(), m_models.end(), kReferenceModel);
        const size_t truth = reference == m_models.end() ? m_models.size() - 1 : size_t(reference - m_models.begin());
        std::vector<std::string> parts;
        for (size_t i = 0; i < images.size(); ++i)
            if (i != truth)
                parts.push_back(format("{} {:.4f}", m_models[i], relative_rms(images[i], images[truth])));
        return format("relative RMS against {}: {}", m_models[truth], OIIO::Strutil::join(parts, ", "));
    }

    bool finish_frame(ImageBuf& frame, size_t index, std::string& error)
    {
        const std::string& output = m_request.output;
        const bool is_kept = holds_all_frames(output) || !m_request.sheet.contact_sheet.empty();
        const std::string path = frame_path(output, m_request.frames[index]);
        if (is_exr_name(path) && !m_stage.write(frame, path, error))
            return false;
        if (is_exr_name(path) && !is_kept)
            return true;
        ImageBuf picture = OIIO::ImageBufAlgo::channels(frame, 4, {});
        picture.specmod().extra_attribs = frame.spec().extra_attribs;
        std::string note;
        if (!show_on_display(picture, m_request.display, m_shot.space(), m_request.filter.colorconfig,
                             m_options.threads, note, error))
            return false;
        m_options.report(note);
        if (!is_exr_name(path) && !holds_all_frames(path) && !write_picture(picture, path, error))
            return false;
        if (is_kept)
            m_pictures.push_back(picture.copy(OIIO::TypeUInt8)); // films are long
        return true;
    }

    bool write_films(std::string& error)
    {
        const std::string &output = m_request.output, &sheet = m_request.sheet.contact_sheet;
        if (is_film_name(output) && !write_film(m_pictures, output, m_request.sheet.fps, error))
            return false;
        if (is_animation_name(output) && !write_animation(m_pictures, output, m_request.sheet.fps, error))
            return false;
        return sheet.empty() || write_picture(contact_sheet(m_pictures, kSheetWidth), sheet, error);
    }

    const Request& m_request;
    StageMain& m_stage;
    MakeOptions m_options;
    Shot m_shot;
    const std::vector<std::string> m_models;
    double m_stops = 0;
    std::vector<ImageBuf> m_pictures;
};

} // namespace

bool shoot(const Request& request, StageMain& stage, std::string& error)
{
    return Shooting(request, stage).run(error);
}

} // namespace vmlight::frames
