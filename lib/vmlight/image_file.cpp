// SPDX-License-Identifier: Apache-2.0
#include <vmlight/image_file.h>

#include <vmlight/channels.h>
#include <vmlight/oiio.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

namespace vmlight {
namespace {

using OIIO::Strutil::fmt::format;

std::string folder_of(const std::string& path)
{
    const std::string folder = OIIO::Filesystem::parent_path(path);
    return folder.empty() ? "." : folder;
}

// Where the links lead that `path` may be, whether there is a file or not; "" if in circles.
std::string link_target(std::string path)
{
    constexpr int kMostLinks = 40; // as the system's
    std::error_code fault;
    for (int link = 0; link < kMostLinks; ++link) {
        const auto target = std::filesystem::read_symlink(path, fault);
        if (fault)
            return path;
        path = target.is_absolute() ? target.string() : folder_of(path) + "/" + target.string();
    }
    return "";
}

// A name beside `path` that no file has.
std::string temporary_path(const std::string& path)
{
    // Cut, since the file system may take no longer names than this. Every % becomes a random digit: not the folder's.
    const std::string name = OIIO::Filesystem::filename(path).substr(0, 200);
    return folder_of(path) + "/" + OIIO::Filesystem::unique_path("." + name + ".%%%%%%%%.part");
}

// A file that keeps its failure to itself: OpenEXR's writing threads, told of a full disk, wait for one another for
// ever.
class OutputFile : public OIIO::Filesystem::IOFile
{
public:
    explicit OutputFile(const std::string& path)
        : IOFile(path, Write)
    {
        if (!opened())
            m_reason = error();
    }

    size_t write(const void* bytes, size_t size) override
    {
        if (sound() && IOFile::write(bytes, size) != size)
            m_reason = std::strerror(errno);
        return size;
    }
    // The file's bytes must be on the disk before its name is, or a crash could leave the name with nothing behind it.
    void flush_to_disk()
    {
        if (sound() && (std::fflush(handle()) != 0 || ::fsync(::fileno(handle())) != 0))
            m_reason = std::strerror(errno);
    }
    bool sound() const { return m_reason.empty(); }
    const std::string& reason() const { return m_reason; }

private:
    std::string m_reason;
};

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

void flush_folder(const std::string& path)
{
    const int folder = ::open(path.c_str(), O_RDONLY);
    if (folder < 0)
        return;
    ::fsync(folder);
    ::close(folder);
}

bool fits_half(const OIIO::ImageBuf& image, std::string& error)
{
    for (const std::string& channel : image.spec().channelnames)
        if (is_packed_channel(channel)) {
            error = format("channel {} holds whole numbers below 2^24, of which half keeps those to 2048: write float",
                           channel);
            return false;
        }
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

bool read_image(OIIO::ImageBuf& dst, const std::string& path, std::string& error, int subimage)
{
    if (!OIIO::Filesystem::is_regular(path) && path.find('?') == std::string::npos) {
        error = format("\"{}\": {}", path, OIIO::Filesystem::exists(path) ? "not a file" : "no such file");
        return false;
    }
    dst.reset(path, subimage);
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
    const std::string target = link_target(path);
    if (target.empty())
        return format("\"{}\": a link that leads in circles", path);
    if (OIIO::Filesystem::is_directory(target))
        return format("\"{}\": is a folder", path);
    if (OIIO::Filesystem::exists(target) && !OIIO::Filesystem::is_regular(target))
        return format("\"{}\": is a device or a pipe, which a file would replace", path);
    const std::string folder = folder_of(target);
    if (!OIIO::Filesystem::is_directory(folder))
        return format("\"{}\": no folder \"{}\"", path, folder);
    // Rights alone do not tell: some folders (/proc) take no files from anyone.
    const std::string trial = temporary_path(target);
    const int file = ::open(trial.c_str(), O_CREAT | O_EXCL | O_WRONLY, 0600);
    if (file < 0)
        return format("\"{}\": the folder \"{}\" cannot be written: {}", path, folder, std::strerror(errno));
    ::close(file);
    ::unlink(trial.c_str());
    return "";
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

    const std::string target = link_target(path), temporary = temporary_path(target);
    std::vector<OIIO::ImageSpec> specs;
    for (const OIIO::ImageBuf& image : images) {
        OIIO::ImageSpec& spec = specs.emplace_back(image.spec());
        spec.set_format(half ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT);
        spec.attribute("compression", "zip");
        // OIIO writes the time of day into every EXR that names no date.
        spec.attribute("DateTime", "");
    }

    const auto failed = [&](const std::string& reason) {
        // The temporary file's name would tell the user nothing.
        error = oiio::named_reason(path, OIIO::Strutil::replace(reason, temporary, path, true));
        OIIO::Filesystem::remove(temporary);
        return false;
    };
    auto out = OIIO::ImageOutput::create("openexr");
    if (!out)
        return failed(OIIO::geterror());
    OutputFile file(temporary);
    if (!file.sound())
        return failed(file.reason());
    const int count = int(specs.size());
    if (!out->set_ioproxy(&file)
        || !(count == 1 ? out->open(temporary, specs[0]) : out->open(temporary, count, specs.data())))
        return failed(oiio::reason(*out));
    Watch watch { progress, file };
    bool written = true;
    for (int i = 0; i < count && written && !watch.stopped; ++i)
        written = (i == 0 || out->open(temporary, specs[size_t(i)], OIIO::ImageOutput::AppendSubimage))
            && out->write_image(OIIO::TypeDesc::FLOAT, images[i].localpixels(), OIIO::AutoStride, OIIO::AutoStride,
                                OIIO::AutoStride, Watch::report, &watch);
    const bool closed = out->close();
    if (watch.stopped)
        return failed("interrupted");
    if (file.sound() && (!written || !closed))
        return failed(oiio::reason(*out));
    file.flush_to_disk();
    if (!file.sound())
        return failed(file.reason());
    file.close();
    if (std::rename(temporary.c_str(), target.c_str()) != 0)
        return failed(std::strerror(errno));
    flush_folder(folder_of(target));
    return true;
}

} // namespace vmlight
