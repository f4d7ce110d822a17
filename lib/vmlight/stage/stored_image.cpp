// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/stored_image.h>

#include <vmlight/base/available_memory.h>
#include <vmlight/base/file_stamp.h>
#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/base/once_cache.h>
#include <vmlight/image/image_file.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/stage/source_cache.h>

#include <OpenImageIO/filesystem.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

namespace vmlight {
namespace {

constexpr size_t kMostBlocks = size_t(256) << 20; // bytes
constexpr int kStripRows = 64;

/// The unit of reading: a tile of the file, or some scanlines.
struct Block
{
    std::vector<float> pixels;
    size_t bytes() const { return sizeof(*this) + pixels.size() * sizeof(float); }
};

/// Keyed by file and block. Never destroyed: host threads may still read while the process exits.
using Blocks = OnceCache<std::pair<uint64_t, int64_t>, Block>;
Blocks& blocks()
{
    static auto& all = *new Blocks(kMostBlocks);
    return all;
}

uint64_t next_id()
{
    static std::atomic<uint64_t> count { 0 };
    return ++count;
}

// A name with ?query need not be a file: another plugin may generate the image.
bool stamp_image(std::string& stamp, const std::string& path, std::string& error)
{
    if (!OIIO::Filesystem::exists(path) && may_be_image(path)
        && !OIIO::Filesystem::exists(path.substr(0, path.find('?')))) {
        stamp = path + "\n";
        return true;
    }
    return stamp_file(stamp, path, error);
}

bool is_unchanged(const std::string& stamp, const std::string& path, std::string& error)
{
    return stamp == path + "\n" || check_stamp(stamp, path, error); // a bare name cannot change
}

// A float image of `spec`, its pixels not set. `name` is for messages.
bool allocate(OIIO::ImageBuf& dst, const std::string& name, OIIO::ImageSpec spec, std::string& error)
{
    spec.set_format(OIIO::TypeFloat);
    error = memory_shortage(spec);
    if (error.empty()) {
        dst.reset(name, spec, OIIO::InitializePixels::No);
        if (!dst.localpixels())
            error = format("out of memory for {}x{} pixels", spec.width, spec.height);
    }
    if (!error.empty() && !name.empty())
        error = format("\"{}\": {}", name, error);
    return error.empty();
}

class StoredImage : public PixelSource
{
public:
    StoredImage(const std::string& key, const std::string& stamp, const std::string& path, int first)
        : PixelSource(key)
        , m_stamp(stamp)
        , m_path(path)
        , m_first(first)
        , m_id(next_id())
    {
    }
    ~StoredImage() override { blocks().erase({ m_id, 0 }, { m_id + 1, 0 }); }

    bool open(std::string& error)
    {
        const auto file = open_image(m_path, error);
        if (!file)
            return false;
        if (!file->seek_subimage(m_first, 0)) {
            error = oiio::with_path(m_path, oiio::error_line(*file));
            return false;
        }
        m_spec = file->spec();
        const std::string fault = header_fault(m_spec);
        if (!fault.empty())
            error = format("\"{}\": {}", m_path, fault);
        if (m_spec.deep || m_spec.depth > 1)
            error = format("\"{}\": a {} image", m_path, m_spec.deep ? "deep" : "volume");
        m_specs.push_back(m_spec);
        if (m_spec.get_string_attribute("vmlight:stack") == "true")
            while (file->seek_subimage(m_first + int(m_specs.size()), 0))
                m_specs.push_back(file->spec());
        return error.empty();
    }

    int subimages() const override { return int(m_specs.size()); }
    const OIIO::ImageSpec& spec_of(int subimage) const override { return m_specs[size_t(subimage)]; }

    bool read(OIIO::ROI roi, float* dst, std::string& error) override
    {
        const auto open_file = [&](std::string& reason) {
            m_file = open_image(m_path, reason);
            if (m_file && is_unchanged(m_stamp, m_path, reason)
                && (!m_file->seek_subimage(m_first, 0) || OIIO::get_roi(m_file->spec()) != OIIO::get_roi(m_spec)))
                reason = format("\"{}\": changed since it was opened", m_path);
            return reason.empty();
        };
        if (!m_open.run(open_file, error))
            return false;
        const int wide = m_spec.tile_width ? m_spec.tile_width : m_spec.width;
        const int high = m_spec.tile_width ? m_spec.tile_height : kStripRows;
        const int across = (m_spec.width + wide - 1) / wide;
        try {
            for (int j = (roi.ybegin - m_spec.y) / high; j <= (roi.yend - 1 - m_spec.y) / high; ++j)
                for (int i = (roi.xbegin - m_spec.x) / wide; i <= (roi.xend - 1 - m_spec.x) / wide; ++i) {
                    const OIIO::ROI whole(m_spec.x + i * wide, m_spec.x + (i + 1) * wide, m_spec.y + j * high,
                                          m_spec.y + (j + 1) * high);
                    const OIIO::ROI own = OIIO::roi_intersection(OIIO::get_roi(m_spec), whole);
                    const auto block = blocks().get({ m_id, int64_t(j) * across + i }, [&] { return read_block(own); });
                    copy(OIIO::roi_intersection(own, roi), own, block->pixels.data(), roi, dst);
                }
        } catch (const BadBlock& bad) {
            error = oiio::with_path(m_path, bad.what());
        }
        return error.empty();
    }

    // What is in the file now: an hour may have passed since it was opened, and a change of its time alone must not
    // fail the run.
    bool make(std::vector<OIIO::ImageBuf>& dst, ImageRange range, const MakeOptions& options,
              std::string& error) override
    {
        dst.clear();
        for (int image = range.first; image < range.first + range.count; ++image)
            if (!allocate(dst.emplace_back(), m_path, spec_of(image), error)
                || !read_file(image, static_cast<float*>(dst.back().localpixels()), options.threads, error))
                return false;
        return true;
    }

    // The image as it was when it was opened, bypassing the block cache.
    bool read_unchanged(int subimage, float* dst, std::string& error)
    {
        return is_unchanged(m_stamp, m_path, error) && read_file(subimage, dst, 1, error);
    }
    const std::string& path() const { return m_path; }

    bool failed() const override { return m_open.failed(); }

private:
    bool read_file(int subimage, float* dst, int threads, std::string& error) const
    {
        const auto file = open_image(m_path, error);
        if (!file)
            return false;
        if (!file->seek_subimage(m_first + subimage, 0)) {
            error = oiio::with_path(m_path, oiio::error_line(*file));
            return false;
        }
        const OIIO::ImageSpec& spec = spec_of(subimage);
        if (OIIO::get_roi(file->spec()) != OIIO::get_roi(spec) || file->spec().channelnames != spec.channelnames) {
            error = format("\"{}\": changed since it was opened", m_path);
            return false;
        }
        file->threads(threads);
        if (oiio::has_read(*file, file->read_image(m_first + subimage, 0, 0, spec.nchannels, OIIO::TypeFloat, dst)))
            return true;
        error = oiio::with_path(m_path, oiio::pixels_error(oiio::error_line(*file)));
        return false;
    }

    // Thrown through the cache, which keeps no failures: the next read fails again.
    using BadBlock = std::runtime_error;

    std::shared_ptr<const Block> read_block(OIIO::ROI roi)
    {
        std::string reason;
        if (!is_unchanged(m_stamp, m_path, reason))
            throw BadBlock("changed since it was opened");
        auto block = std::make_shared<Block>();
        block->pixels.resize(size_t(roi.width()) * roi.height() * m_spec.nchannels);
        float* pixels = block->pixels.data();
        const int channels = m_spec.nchannels, z = m_spec.z;
        const bool good = m_spec.tile_width
            ? m_file->read_tiles(m_first, 0, roi.xbegin, roi.xend, roi.ybegin, roi.yend, z, z + 1, 0, channels,
                                 OIIO::TypeFloat, pixels)
            : m_file->read_scanlines(m_first, 0, roi.ybegin, roi.yend, z, 0, channels, OIIO::TypeFloat, pixels);
        if (!oiio::has_read(*m_file, good))
            throw BadBlock(oiio::pixels_error(oiio::error_line(*m_file)));
        return block;
    }

    // Copies the pixels of `both` from `from`, which holds `own`, to `to`, which holds `roi`.
    void copy(OIIO::ROI both, OIIO::ROI own, const float* from, OIIO::ROI roi, float* to) const
    {
        const size_t channels = size_t(m_spec.nchannels);
        for (int y = both.ybegin; y < both.yend; ++y)
            std::copy_n(from + (size_t(y - own.ybegin) * own.width() + (both.xbegin - own.xbegin)) * channels,
                        size_t(both.width()) * channels,
                        to + (size_t(y - roi.ybegin) * roi.width() + (both.xbegin - roi.xbegin)) * channels);
    }

    const std::string m_stamp, m_path;
    const int m_first; // of its images
    const uint64_t m_id;
    std::unique_ptr<OIIO::ImageInput> m_file;
    std::vector<OIIO::ImageSpec> m_specs;
    RunOnce m_open;
};

} // namespace

PixelSourcePointer open_stored_image(const std::string& path, std::string& error, int first)
{
    std::string stamp;
    if (!stamp_image(stamp, path, error))
        return nullptr;
    const std::string key = first == 0 ? stamp : format("image {} of ", first) + stamp;
    if (PixelSourcePointer known = find_source(key))
        return known;
    auto image = std::make_shared<StoredImage>(key, stamp, path, first);
    return image->open(error) ? keep_source(image) : nullptr;
}

bool read_all(OIIO::ImageBuf& dst, PixelSource& source, std::string& error, int subimage)
{
    if (!allocate(dst, "", source.spec_of(subimage), error))
        return false;
    auto* pixels = static_cast<float*>(dst.localpixels());
    if (auto* file = dynamic_cast<StoredImage*>(&source))
        return file->read_unchanged(subimage, pixels, error);
    return source.read_of(subimage, OIIO::get_roi(dst.spec()), pixels, error);
}

} // namespace vmlight
