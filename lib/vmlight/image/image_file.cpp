// SPDX-License-Identifier: Apache-2.0
#include <vmlight/image/image_file.h>

#include <vmlight/base/available_memory.h>
#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/base/output_file.h>
#include <vmlight/image/exr_output.h>
#include <vmlight/image/file_claims.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imagecache.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

namespace vmlight {
namespace {

constexpr int kRowsAtOnce = 256;

bool fits_half(const OIIO::ImageBuf& image, std::string& error)
{
    const auto stats = OIIO::ImageBufAlgo::computePixelStats(image);
    for (size_t c = 0; c < stats.max.size(); ++c) {
        // max and min ignore infinities.
        const float worst = stats.infcount[c] > 0 ? std::numeric_limits<float>::infinity()
                                                  : std::max(std::abs(stats.max[c]), std::abs(stats.min[c]));
        error = half_range_fault(image.spec().channelnames[c], worst);
        if (!error.empty())
            return false;
    }
    return true;
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

bool is_whole_tiff(const std::string& path, int subimage, std::string& error)
{
    const auto file = open_image(path, error);
    if (!file)
        return false;
    const OIIO::ImageSpec spec = file->spec(subimage, 0);
    const int rows = spec.tile_height > 0 ? spec.tile_height : kRowsAtOnce, end = spec.y + spec.height;
    std::vector<char> pixels(size_t(spec.scanline_bytes(true)) * size_t(rows));
    for (int y = spec.y; y < end; y += rows) {
        const int next = std::min(y + rows, end);
        const bool good = spec.tile_width > 0
            ? file->read_tiles(subimage, 0, spec.x, spec.x + spec.width, y, next, spec.z, spec.z + 1, 0, spec.nchannels,
                               OIIO::TypeUnknown, pixels.data())
            : file->read_scanlines(subimage, 0, y, next, spec.z, 0, spec.nchannels, OIIO::TypeUnknown, pixels.data());
        if (!oiio::has_read(*file, good)) {
            error = oiio::with_path(path, oiio::pixels_error(oiio::error_line(*file)));
            return false;
        }
    }
    return true;
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
        const bool has_header = dst.spec().width > 0;
        const std::string reason = oiio::error_line(dst);
        error = oiio::with_path(path, has_header ? oiio::pixels_error(reason) : reason);
        dst.clear();
        return false;
    }
    if (dst.file_format_name() == std::string("tiff") && !is_whole_tiff(path, subimage, error)) {
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
    std::vector<OIIO::ImageSpec> specs;
    for (const OIIO::ImageBuf& image : images) {
        if (params.format == "half" && !fits_half(image, error)) {
            error = format("\"{}\": {}", path, error);
            return false;
        }
        specs.push_back(image.spec());
    }
    ExrOutput file(path, params);
    if (!file.open(specs, error))
        return false;
    for (int i = 0; i < int(specs.size()); ++i)
        if (!file.write_image(i, static_cast<const float*>(images[i].localpixels()), progress, error))
            return false;
    return file.commit(error);
}

} // namespace vmlight
