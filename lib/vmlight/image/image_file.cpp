// SPDX-License-Identifier: Apache-2.0
#include <vmlight/image/image_file.h>

#include <vmlight/base/memory_need.h>
#include <vmlight/base/oiio.h>
#include <vmlight/base/output_file.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imagecache.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace vmlight {
namespace {

using OIIO::Strutil::fmt::format;

// OIIO's callback carries a pointer and returns true to stop; a writer that was stopped says that all went well.
struct Watch
{
    const Progress& progress;
    const OutputFile& file;
    bool stopped = false;

    static bool report(void* watch, float done)
    {
        Watch& self = *static_cast<Watch*>(watch);
        self.stopped = self.stopped || (self.progress && !self.progress(double(done)));
        return self.stopped || !self.file.sound();
    }
};

bool fits_half(const OIIO::ImageBuf& image, std::string& error)
{
    constexpr float kLargestHalf = 65504;
    const auto stats = OIIO::ImageBufAlgo::computePixelStats(image);
    for (size_t c = 0; c < stats.max.size(); ++c) {
        // The extremes are those of finite values.
        const float worst = stats.infcount[c] > 0 ? std::numeric_limits<float>::infinity()
                                                  : std::max(std::abs(stats.max[c]), std::abs(stats.min[c]));
        if (!(worst <= kLargestHalf)) {
            error = format("channel {} reaches {:g}, beyond the range of half (65504): write float",
                           image.spec().channelnames[c], worst);
            return false;
        }
    }
    return true;
}

} // namespace

bool may_be_image(const std::string& name)
{
    return OIIO::Filesystem::is_regular(name)
        || (name.find('?') != std::string::npos && !OIIO::Filesystem::exists(name));
}

std::string header_fault(const OIIO::ImageSpec& spec)
{
    constexpr int kLongestSide = 1 << 20;
    for (const auto& [width, height] : { std::pair(spec.width, spec.height), { spec.full_width, spec.full_height } })
        if (std::max(width, height) > kLongestSide)
            return format("its header says {}x{} pixels, of at most {} a side", width, height, kLongestSide);
    return "";
}

bool read_image(OIIO::ImageBuf& dst, const std::string& path, std::string& error, int subimage)
{
    if (!may_be_image(path)) {
        error = format("\"{}\": {}", path, OIIO::Filesystem::exists(path) ? "not a file" : "no such file");
        return false;
    }
    // An ImageBuf takes the header from OIIO's cache, which may know that of a file since replaced, and then reads the
    // new pixels beyond its memory.
    const auto cache = OIIO::ImageCache::create(true);
    cache->invalidate(OIIO::ustring(path));
    dst.reset(path, subimage);
    // Without a file its spec is empty, and read() tells.
    std::string fault = header_fault(dst.spec());
    if (fault.empty())
        fault = memory_fault(dst.spec());
    if (!fault.empty()) {
        error = format("\"{}\": {}", path, fault);
        dst.clear();
        return false;
    }
    if (!dst.read(subimage, 0, true, OIIO::TypeDesc::FLOAT)) {
        error = oiio::named_reason(path, oiio::reason(dst));
        dst.clear();
        return false;
    }
    return true;
}

std::string output_name_fault(const std::string& path)
{
    return OIIO::Strutil::iends_with(path, ".exr")
        ? ""
        : format("\"{}\": outputs are EXR files; name it .exr, then convert it with oiiotool", path);
}

std::string output_fault(const std::string& path)
{
    const std::string name_fault = output_name_fault(path);
    if (!name_fault.empty())
        return name_fault;
    return output_file_fault(path);
}

bool write_image(const OIIO::ImageBuf& image, const std::string& path, const std::string& format_name,
                 const Progress& progress, std::string& error)
{
    return write_images(OIIO::cspan<OIIO::ImageBuf>(&image, 1), path, format_name, progress, error);
}

bool write_images(OIIO::cspan<OIIO::ImageBuf> images, const std::string& path, const std::string& format_name,
                  const Progress& progress, std::string& error)
{
    error = output_fault(path);
    const bool half = format_name == "half";
    for (const OIIO::ImageBuf& image : images)
        if (error.empty() && half && !fits_half(image, error))
            error = format("\"{}\": {}", path, error);
    if (!error.empty())
        return false;

    std::vector<OIIO::ImageSpec> specs;
    for (const OIIO::ImageBuf& image : images) {
        OIIO::ImageSpec& spec = specs.emplace_back(image.spec());
        spec.set_format(half ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT);
        spec.attribute("compression", "zip");
        // OIIO writes the time of day into every EXR that names no date.
        spec.attribute("DateTime", "");
    }

    OutputFile file(path);
    const auto failed = [&](const std::string& reason) {
        // The temporary file's name would tell the user nothing.
        error = oiio::named_reason(path, OIIO::Strutil::replace(reason, file.temporary(), path, true));
        return false;
    };
    auto out = OIIO::ImageOutput::create("openexr");
    if (!out)
        return failed(OIIO::geterror());
    if (!file.sound())
        return failed(file.reason());
    const int count = int(specs.size());
    if (!out->set_ioproxy(&file)
        || !(count == 1 ? out->open(file.temporary(), specs[0]) : out->open(file.temporary(), count, specs.data())))
        return failed(oiio::reason(*out));
    Watch watch { progress, file };
    bool written = true;
    for (int i = 0; i < count && written && !watch.stopped; ++i)
        written = (i == 0 || out->open(file.temporary(), specs[size_t(i)], OIIO::ImageOutput::AppendSubimage))
            && out->write_image(OIIO::TypeDesc::FLOAT, images[i].localpixels(), OIIO::AutoStride, OIIO::AutoStride,
                                OIIO::AutoStride, Watch::report, &watch);
    const bool closed = out->close();
    if (watch.stopped)
        return failed("interrupted");
    if (file.sound() && (!written || !closed))
        return failed(oiio::reason(*out));
    return file.keep() || failed(file.reason());
}

} // namespace vmlight
