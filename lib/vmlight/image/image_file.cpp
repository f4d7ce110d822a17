// SPDX-License-Identifier: Apache-2.0
#include <vmlight/image/image_file.h>

#include <vmlight/base/available_memory.h>
#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/base/output_file.h>
#include <vmlight/image/file_claims.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imagecache.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <new>
#include <utility>
#include <vector>

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

bool fits_half(const OIIO::ImageBuf& image, std::string& error)
{
    constexpr float kLargestHalf = 65504;
    const auto stats = OIIO::ImageBufAlgo::computePixelStats(image);
    for (size_t c = 0; c < stats.max.size(); ++c) {
        // max and min ignore infinities.
        const float worst = stats.infcount[c] > 0 ? std::numeric_limits<float>::infinity()
                                                  : std::max(std::abs(stats.max[c]), std::abs(stats.min[c]));
        if (!(worst <= kLargestHalf)) {
            error = format("channel {} reaches {:g}, but the maximum of half is 65504: write float",
                           image.spec().channelnames[c], worst);
            return false;
        }
    }
    return true;
}

// What keeps the file `path`, which holds `images`, from being read, or "". Reads of each image the last row or tile.
std::string unreadable(const std::string& path, OIIO::cspan<OIIO::ImageBuf> images)
{
    const auto in = OIIO::ImageInput::create("openexr");
    OIIO::ImageSpec spec;
    if (!in || !in->open(path, spec))
        return in ? oiio::error_line(*in) : oiio::error_line();
    for (int i = 0; i < int(images.size()); ++i) {
        if (!in->seek_subimage(i, 0) || OIIO::get_roi(in->spec()) != OIIO::get_roi(images[i].spec()))
            return format("image {} of {} is not what was written", i + 1, images.size());
        spec = in->spec();
        const int x = spec.tile_width ? spec.x + (spec.width - 1) / spec.tile_width * spec.tile_width : spec.x;
        const int y
            = spec.y + (spec.tile_width ? (spec.height - 1) / spec.tile_height * spec.tile_height : spec.height - 1);
        const int xend = spec.x + spec.width, yend = spec.y + spec.height;
        std::vector<float> last(size_t(xend - x) * size_t(yend - y) * size_t(spec.nchannels));
        if (!(spec.tile_width
                  ? in->read_tiles(i, 0, x, xend, y, yend, spec.z, spec.z + 1, 0, spec.nchannels, OIIO::TypeFloat,
                                   last.data())
                  : in->read_scanlines(i, 0, y, yend, spec.z, 0, spec.nchannels, OIIO::TypeFloat, last.data())))
            return oiio::error_line(*in);
    }
    return "";
}

// Readers multiply colour by alpha before vmlight can decode it (PNG, TIFF, Targa), unless asked not to.
OIIO::ImageSpec reading_hints()
{
    OIIO::ImageSpec hints;
    hints.attribute("oiio:UnassociatedAlpha", 1);
    return hints;
}

} // namespace

bool may_be_image(const std::string& name)
{
    if (OIIO::Filesystem::exists(name))
        return OIIO::Filesystem::is_regular(name);
    std::string path;
    std::map<std::string, std::string> query;
    return OIIO::Strutil::get_rest_arguments(name, path, query) && !query.empty();
}

std::unique_ptr<OIIO::ImageInput> open_image(const std::string& name, std::string& error)
{
    const FileHeader header = inspect_header(name);
    if (!header.fault.empty()) {
        error = format("\"{}\": {}", name, header.fault);
        return nullptr;
    }
    const OIIO::ImageSpec hints = reading_hints();
    std::string reader = header.reader;
    // OIIO takes what follows a '?' for a query, even in the name of a folder.
    if (reader.empty() && name.find('?') != std::string::npos && OIIO::Filesystem::is_regular(name))
        reader = OIIO::Filesystem::extension(name, false);
    if (!reader.empty()) {
        auto file = OIIO::ImageInput::create(reader);
        OIIO::ImageSpec ignored;
        if (file && file->open(name, ignored, hints))
            return file;
        error = oiio::with_path(name, file ? oiio::error_line(*file) : oiio::error_line());
        return nullptr;
    }
    auto file = OIIO::ImageInput::open(name, &hints);
    if (!file)
        error = oiio::with_path(name, oiio::error_line());
    return file;
}

std::string header_fault(const OIIO::ImageSpec& spec)
{
    constexpr int kLongestSide = 1 << 20;
    for (const auto& [width, height] : { std::pair(spec.width, spec.height), { spec.full_width, spec.full_height } })
        if (std::max(width, height) > kLongestSide)
            return format("its header says {}x{} pixels; the maximum is {} per side", width, height, kLongestSide);
    return "";
}

bool read_image(OIIO::ImageBuf& dst, const std::string& path, std::string& error, int subimage)
{
    if (!may_be_image(path)) {
        error = format("\"{}\": {}", path, OIIO::Filesystem::exists(path) ? "not a file" : "no such file");
        return false;
    }
    std::string fault = claims_fault(path);
    if (!fault.empty()) {
        error = format("\"{}\": {}", path, fault);
        return false;
    }
    // ImageBuf takes the header from OIIO's image cache, which may be stale if the file was replaced, and would then
    // read the new pixels into too small a buffer.
    const auto cache = OIIO::ImageCache::create(true);
    cache->invalidate(OIIO::ustring(path));
    const OIIO::ImageSpec hints = reading_hints();
    dst.reset(path, subimage, 0, nullptr, &hints);
    // If the file cannot be opened the spec is empty, and read() fails.
    fault = header_fault(dst.spec());
    if (fault.empty())
        fault = memory_shortage(dst.spec());
    if (!fault.empty()) {
        error = format("\"{}\": {}", path, fault);
        dst.clear();
        return false;
    }
    if (!dst.read(subimage, 0, true, OIIO::TypeDesc::FLOAT)) {
        error = oiio::with_path(path, oiio::error_line(dst));
        dst.clear();
        return false;
    }
    return true;
}

std::string output_name_fault(const std::string& path)
{
    if (OIIO::Strutil::iends_with(path, ".exr"))
        return "";
    // OIIO's Radiance writer stores a negative channel beside a positive one as a large positive value.
    return OIIO::Strutil::iends_with(path, ".hdr")
        ? format("\"{}\": output must be .exr; convert light afterwards: oiiotool x.exr --clamp:min=0 -o x.hdr", path)
        : format("\"{}\": output must be .exr; convert it with oiiotool afterwards", path);
}

std::string output_fault(const std::string& path)
{
    const std::string name_fault = output_name_fault(path);
    if (!name_fault.empty())
        return name_fault;
    return output_file_fault(path);
}

bool write_image(const OIIO::ImageBuf& image, const std::string& path, const FileParams& file, const Progress& progress,
                 std::string& error)
{
    return write_images(OIIO::cspan<OIIO::ImageBuf>(&image, 1), path, file, progress, error);
}

bool write_images(OIIO::cspan<OIIO::ImageBuf> images, const std::string& path, const FileParams& params,
                  const Progress& progress, std::string& error)
{
    error = output_fault(path);
    const bool half = params.format == "half";
    for (const OIIO::ImageBuf& image : images)
        if (error.empty() && half && !fits_half(image, error))
            error = format("\"{}\": {}", path, error);
    if (!error.empty())
        return false;

    std::vector<OIIO::ImageSpec> specs;
    for (const OIIO::ImageBuf& image : images) {
        OIIO::ImageSpec& spec = specs.emplace_back(image.spec());
        spec.set_format(half ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT);
        spec.attribute("compression", params.compression);
        // OIIO writes the current time unless DateTime is set.
        spec.attribute("DateTime", "");
    }

    OutputFile file(path);
    const auto failed = [&](const std::string& reason) {
        // The temporary file's name means nothing to the user.
        error = oiio::with_path(path, OIIO::Strutil::replace(reason, file.temporary_path(), path, true));
        return false;
    };
    const auto write = [&] {
        auto out = OIIO::ImageOutput::create("openexr");
        if (!out)
            return failed(oiio::error_line());
        if (!file.ok())
            return failed(file.reason());
        const int count = int(specs.size());
        if (!out->set_ioproxy(&file)
            || !(count == 1 ? out->open(file.temporary_path(), specs[0])
                            : out->open(file.temporary_path(), count, specs.data())))
            return failed(oiio::error_line(*out));
        WriteProgress watch { progress, file };
        bool written = true;
        for (int i = 0; i < count && written && !watch.stopped; ++i)
            written = (i == 0 || out->open(file.temporary_path(), specs[size_t(i)], OIIO::ImageOutput::AppendSubimage))
                && out->write_image(OIIO::TypeDesc::FLOAT, images[i].localpixels(), OIIO::AutoStride, OIIO::AutoStride,
                                    OIIO::AutoStride, WriteProgress::report, &watch);
        const bool closed = out->close();
        if (watch.stopped)
            return failed("interrupted");
        if (file.ok() && (!written || !closed))
            return failed(oiio::error_line(*out));
        // OpenEXR writes its table of offsets last, from a destructor, which reports no failure; and a file of several
        // parts by its name, of which the last buffer may be lost unseen.
        const std::string fault = file.ok() ? unreadable(file.temporary_path(), images) : "";
        if (!fault.empty())
            return failed("what was written cannot be read: " + fault);
        return file.commit() || failed(file.reason());
    };
    try {
        return write();
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& exception) { // OpenEXR 3.4 throws where a file grows too large
        return failed(exception.what());
    }
}

} // namespace vmlight
