// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/reader.h>

#include <vmlight/base/parallel.h>
#include <vmlight/base/text_format.h>
#include <vmlight/stage/open_source.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <mutex>
#include <set>
#include <vector>

namespace vmlight {

using OIIO::ImageSpec;
using OIIO::ROI;

namespace {

// oiiotool says only that a name with ?query does not exist as a file, whatever the reader's reason.
void print_once(const std::string& line)
{
    static std::mutex mutex;
    static auto& printed = *new std::set<std::string>;
    const std::lock_guard lock(mutex);
    if (printed.insert(line).second)
        std::fprintf(stderr, "vmlight ERROR: %s\n", line.c_str());
}

} // namespace

// The only place that catches exceptions. Nothing is thrown on purpose: what arrives here is out of memory, or a bug in
// a mesh importer.
template <class Work> bool StageInput::guarded(Work&& work)
{
    try {
        return work();
    } catch (const std::bad_alloc&) {
        errorfmt("out of memory");
    } catch (const std::exception& fault) {
        errorfmt("{}", printable_line(fault.what()));
    } catch (...) {
        errorfmt("unknown exception");
    }
    return false;
}

StageInput::StageInput(const char* stage)
    : m_stage(stage)
{
}

StageInput::~StageInput() = default;

const char* StageInput::format_name() const
{
    return m_stage;
}

int StageInput::supports(OIIO::string_view feature) const
{
    // Names with ?query are those of no file. Earlier versions crash when such a reader fails to open.
    return feature == "procedural" && OIIO_VERSION >= 30118;
}

bool StageInput::valid_file(const std::string& name) const
{
    bool is_ours = false;
    try {
        is_ours = recipe_stage(name) == m_stage;
    } catch (...) {
    }
    return is_ours;
}

bool StageInput::open(const std::string& name, ImageSpec& spec)
{
    return guarded([&] {
        if (!valid_file(name)) {
            errorfmt("\"{}\": not a .{} recipe", printable_line(name), m_stage);
            return false;
        }
        std::string error;
        PixelSourcePointer source = open_source(name, error);
        if (!source) {
            errorfmt("{}", printable_line(error));
            if (name.find('?') != std::string::npos)
                print_once(printable_line(error));
            return false;
        }
        spec = m_spec = source->spec();
        m_subimage = 0;
        m_source = std::move(source);
        return true;
    });
}

bool StageInput::close()
{
    m_source.reset();
    return true;
}

bool StageInput::has(int subimage, int miplevel) const
{
    return m_source && subimage >= 0 && subimage < m_source->subimages() && miplevel == 0;
}

bool StageInput::seek_subimage(int subimage, int miplevel)
{
    if (!has(subimage, miplevel))
        return false;
    if (subimage != m_subimage)
        m_spec = m_source->spec_of(subimage);
    m_subimage = subimage;
    return true;
}

ImageSpec StageInput::spec(int subimage, int miplevel)
{
    return has(subimage, miplevel) ? m_source->spec_of(subimage) : ImageSpec();
}

ImageSpec StageInput::spec_dimensions(int subimage, int miplevel)
{
    ImageSpec dimensions;
    if (has(subimage, miplevel))
        dimensions.copy_dimensions(m_source->spec_of(subimage));
    return dimensions;
}

bool StageInput::read_native_scanline(int, int, int, int, void*)
{
    errorfmt("{} images are tiled: read tiles, not scanlines", m_stage);
    return false;
}

bool StageInput::read_native_tile(int subimage, int miplevel, int x, int y, int z, void* data)
{
    const ImageSpec spec = spec_dimensions(subimage, miplevel);
    return read_native_tiles(subimage, miplevel, x, x + spec.tile_width, y, y + spec.tile_height, z, z + 1, data);
}

bool StageInput::read_native_tiles(int subimage, int miplevel, int xbegin, int xend, int ybegin, int yend, int zbegin,
                                   int zend, void* data)
{
    return read_native_tiles(subimage, miplevel, xbegin, xend, ybegin, yend, zbegin, zend, 0,
                             spec_dimensions(subimage, miplevel).nchannels, data);
}

// `data` is one contiguous image of the region, which ends at tile edges or at the edge of the image.
bool StageInput::read_native_tiles(int subimage, int miplevel, int xbegin, int xend, int ybegin, int yend, int zbegin,
                                   int zend, int chbegin, int chend, void* data)
{
    return guarded([&] {
        const PixelSourcePointer source = m_source;
        // Not m_spec: another thread may be seeking. A closed reader has no source, hence no tiles.
        const ImageSpec none;
        const ImageSpec& spec = has(subimage, miplevel) ? source->spec_of(subimage) : none;
        const ROI image = OIIO::get_roi(spec);
        chend = std::min(chend, spec.nchannels);
        if (spec.undefined() || zbegin != spec.z || zend != spec.z + 1 || chbegin < 0 || chbegin >= chend
            || xbegin < image.xbegin || ybegin < image.ybegin || xend <= xbegin || yend <= ybegin) {
            errorfmt("no such tiles: [{}, {}) x [{}, {}) of {}", xbegin, xend, ybegin, yend, m_stage);
            return false;
        }
        const int across = (xend - xbegin + spec.tile_width - 1) / spec.tile_width;
        const int down = (yend - ybegin + spec.tile_height - 1) / spec.tile_height;
        const size_t pixel = size_t(chend - chbegin), all = size_t(spec.nchannels);
        const size_t pitch = pixel * size_t(xend - xbegin);
        float* const first = static_cast<float*>(data);

        std::mutex mutex;
        std::string error;
        int64_t failed = int64_t(across) * down; // the first tile that could not be read
        const auto read = [&](int64_t tile, int) {
            const int x = xbegin + int(tile % across) * spec.tile_width;
            const int y = ybegin + int(tile / across) * spec.tile_height;
            const ROI asked(x, std::min(x + spec.tile_width, xend), y, std::min(y + spec.tile_height, yend));
            const ROI there = OIIO::roi_intersection(asked, ROI(image.xbegin, image.xend, image.ybegin, image.yend));
            for (int row = asked.ybegin; row < asked.yend; ++row)
                std::fill_n(first + size_t(row - ybegin) * pitch + size_t(asked.xbegin - xbegin) * pixel,
                            size_t(asked.width()) * pixel, 0.0f);
            if (there.width() <= 0 || there.height() <= 0)
                return;
            std::vector<float> texels(all * size_t(there.width()) * size_t(there.height()));
            std::string reason;
            if (!source->read_of(subimage, there, texels.data(), reason)) {
                const std::lock_guard<std::mutex> lock(mutex);
                if (tile < failed) {
                    failed = tile;
                    error = reason;
                }
                return;
            }
            const float* from = texels.data() + chbegin;
            for (int row = there.ybegin; row < there.yend; ++row) {
                float* to = first + size_t(row - ybegin) * pitch + size_t(there.xbegin - xbegin) * pixel;
                for (int column = there.xbegin; column < there.xend; ++column, from += all, to += pixel)
                    std::copy_n(from, pixel, to);
            }
        };
        parallel_items(int64_t(across) * down, threads(), read);
        if (!error.empty())
            errorfmt("{}", printable_line(error)); // here, because OIIO keeps error messages per thread
        return error.empty();
    });
}

} // namespace vmlight
