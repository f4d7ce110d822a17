// SPDX-License-Identifier: Apache-2.0
#include <vmlight/image/exr_output.h>

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <limits>
#include <new>

namespace vmlight {
namespace {

// OIIO's progress callback: gets a pointer, returns true to stop. A writer that was stopped reports success.
struct WriteProgress
{
    const Progress& progress;
    const OutputFile& file;
    bool stopped = false;

    static bool report(void* watch, float done)
    {
        WriteProgress& self = *static_cast<WriteProgress*>(watch);
        self.stopped = self.stopped || (self.progress && !self.progress(double(done)));
        return self.stopped || !self.file.ok();
    }
};

// What keeps the file `path`, which holds `images`, from being read, or "". Reads of each image the last row or tile.
std::string unreadable(const std::string& path, const std::vector<OIIO::ImageSpec>& images)
{
    const auto in = OIIO::ImageInput::create("openexr");
    OIIO::ImageSpec spec;
    if (!in || !in->open(path, spec))
        return in ? oiio::error_line(*in) : oiio::error_line();
    for (size_t i = 0; i < images.size(); ++i) {
        if (!in->seek_subimage(int(i), 0) || OIIO::get_roi(in->spec()) != OIIO::get_roi(images[i]))
            return format("image {} of {} is not what was written", i + 1, images.size());
        spec = in->spec();
        const int x = spec.tile_width ? spec.x + (spec.width - 1) / spec.tile_width * spec.tile_width : spec.x;
        const int y
            = spec.y + (spec.tile_width ? (spec.height - 1) / spec.tile_height * spec.tile_height : spec.height - 1);
        const int xend = spec.x + spec.width, yend = spec.y + spec.height;
        std::vector<float> last(size_t(xend - x) * size_t(yend - y) * size_t(spec.nchannels));
        if (!(spec.tile_width
                  ? in->read_tiles(int(i), 0, x, xend, y, yend, spec.z, spec.z + 1, 0, spec.nchannels, OIIO::TypeFloat,
                                   last.data())
                  : in->read_scanlines(int(i), 0, y, yend, spec.z, 0, spec.nchannels, OIIO::TypeFloat, last.data())))
            return oiio::error_line(*in);
    }
    return "";
}

} // namespace

std::string half_range_fault(const std::string& channel, float value)
{
    return std::abs(value) <= kLargestHalf
        ? ""
        : format("channel {} reaches {:g}, but the maximum of half is 65504: write float", channel, std::abs(value));
}

ExrOutput::ExrOutput(const std::string& path, const FileParams& params)
    : m_path(path)
    , m_params(params)
{
}

ExrOutput::~ExrOutput() = default;

bool ExrOutput::fail(const std::string& reason, std::string& error) const
{
    // The temporary file's name means nothing to the user.
    error = oiio::with_path(m_path,
                            m_file ? OIIO::Strutil::replace(reason, m_file->temporary_path(), m_path, true) : reason);
    return false;
}

bool ExrOutput::guard(const std::function<bool()>& work, std::string& error)
{
    try {
        return work();
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& exception) { // OpenEXR 3.4 throws where a file grows too large
        return fail(exception.what(), error);
    }
}

bool ExrOutput::open(const std::vector<OIIO::ImageSpec>& images, std::string& error)
{
    error = output_fault(m_path);
    if (!error.empty())
        return false;
    m_specs = images;
    for (OIIO::ImageSpec& spec : m_specs) {
        spec.set_format(m_params.format == "half" ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT);
        spec.attribute("compression", m_params.compression);
        // OIIO writes the current time unless DateTime is set.
        spec.attribute("DateTime", "");
    }
    m_file = std::make_unique<OutputFile>(m_path);
    return guard(
        [&] {
            m_out = OIIO::ImageOutput::create("openexr");
            if (!m_out)
                return fail(oiio::error_line(), error);
            if (!m_file->ok())
                return fail(m_file->reason(), error);
            const int count = int(m_specs.size());
            return (m_out->set_ioproxy(m_file.get())
                    && (count == 1 ? m_out->open(m_file->temporary_path(), m_specs[0])
                                   : m_out->open(m_file->temporary_path(), count, m_specs.data())))
                || fail(oiio::error_line(*m_out), error);
        },
        error);
}

bool ExrOutput::write_image(int index, const float* pixels, const Progress& progress, std::string& error)
{
    return guard(
        [&] {
            WriteProgress watch { progress, *m_file };
            const bool written
                = (index == 0
                   || m_out->open(m_file->temporary_path(), m_specs[size_t(index)], OIIO::ImageOutput::AppendSubimage))
                && m_out->write_image(OIIO::TypeDesc::FLOAT, pixels, OIIO::AutoStride, OIIO::AutoStride,
                                      OIIO::AutoStride, WriteProgress::report, &watch);
            if (watch.stopped)
                return fail("interrupted", error);
            return (written && m_file->ok()) || fail(m_file->ok() ? oiio::error_line(*m_out) : m_file->reason(), error);
        },
        error);
}

bool ExrOutput::write_rows(int ybegin, int yend, const float* pixels, std::string& error)
{
    const OIIO::ImageSpec& spec = m_specs[0];
    if (m_params.format == "half")
        for (size_t i = 0; i < size_t(yend - ybegin) * size_t(spec.width) * size_t(spec.nchannels); ++i)
            if (std::abs(pixels[i]) > kLargestHalf)
                return fail(half_range_fault(spec.channelnames[i % size_t(spec.nchannels)], pixels[i]), error);
    return guard(
        [&] {
            const bool written = spec.tile_width
                ? m_out->write_tiles(spec.x, spec.x + spec.width, ybegin, yend, spec.z, spec.z + 1,
                                     OIIO::TypeDesc::FLOAT, pixels)
                : m_out->write_scanlines(ybegin, yend, spec.z, OIIO::TypeDesc::FLOAT, pixels);
            return (written && m_file->ok()) || fail(m_file->ok() ? oiio::error_line(*m_out) : m_file->reason(), error);
        },
        error);
}

bool ExrOutput::commit(std::string& error)
{
    return guard(
        [&] {
            if (!m_out->close() && m_file->ok())
                return fail(oiio::error_line(*m_out), error);
            // OpenEXR writes its table of offsets last, from a destructor, which reports no failure; and a file of
            // several parts by its name, of which the last buffer may be lost unseen.
            const std::string fault = m_file->ok() ? unreadable(m_file->temporary_path(), m_specs) : "";
            if (!fault.empty())
                return fail("what was written cannot be read: " + fault, error);
            return m_file->commit() || fail(m_file->reason(), error);
        },
        error);
}

} // namespace vmlight
