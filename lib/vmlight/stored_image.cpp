// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stored_image.h>

#include <vmlight/oiio.h>
#include <vmlight/once_cache.h>

#include <OpenImageIO/imagecache.h>
#include <OpenImageIO/strutil.h>

namespace vmlight {
namespace {

using OIIO::Strutil::fmt::format;

// A pointer in OIIO 2, shared in OIIO 3.
using Cache = decltype(OIIO::ImageCache::create(false));

class StoredImage : public PixelSource
{
public:
    StoredImage(const std::string& key, const std::string& path)
        : PixelSource(key)
        , m_path(path)
    {
    }
    ~StoredImage() override
    {
        m_image.reset();
        if (m_cache)
            OIIO::ImageCache::destroy(m_cache);
    }

    bool open(std::string& error)
    {
        const auto file = OIIO::ImageInput::open(m_path);
        if (!file) {
            error = oiio::named_reason(m_path, OIIO::geterror());
            return false;
        }
        m_spec = file->spec();
        if (m_spec.deep || m_spec.depth > 1)
            error = format("\"{}\": a {} image", m_path, m_spec.deep ? "deep" : "volume");
        return error.empty();
    }

    bool read(OIIO::ROI roi, float* dst, std::string& error) override
    {
        const auto open_pixels = [&](std::string& reason) {
            m_cache = OIIO::ImageCache::create(false);
            m_cache->attribute("max_memory_MB", 256.0f);
            m_cache->attribute("autotile", 64); // a file of scanlines costs the rows that are asked for
            m_cache->attribute("autoscanline", 1);
            m_image.reset(m_path, 0, 0, m_cache);
            const bool same = check_stamp(key(), m_path, reason);
            if (same && m_image.roi() != OIIO::get_roi(m_spec))
                reason = m_image.has_error() ? oiio::named_reason(m_path, m_image.geterror())
                                             : format("\"{}\": changed since it was opened", m_path);
            return reason.empty();
        };
        if (!m_open.run(open_pixels, error))
            return false;
        roi.chbegin = 0;
        roi.chend = m_spec.nchannels;
        roi.zbegin = m_spec.z;
        roi.zend = m_spec.z + 1;
        if (m_image.get_pixels(roi, OIIO::TypeFloat, dst))
            return true;
        error = oiio::named_reason(m_path, m_image.geterror());
        return false;
    }

    // At once, without the cache.
    bool read_file(float* dst, std::string& error)
    {
        const auto file = OIIO::ImageInput::open(m_path);
        if (!check_stamp(key(), m_path, error))
            return false;
        if (file)
            file->threads(1);
        if (file && file->read_image(0, 0, 0, m_spec.nchannels, OIIO::TypeFloat, dst))
            return true;
        error = oiio::named_reason(m_path, file ? file->geterror() : OIIO::geterror());
        return false;
    }

    bool failed() const override { return m_open.failed(); }

private:
    const std::string m_path;
    Cache m_cache {};
    OIIO::ImageBuf m_image;
    Once m_open;
};

} // namespace

PixelSourcePointer open_stored_image(const std::string& path, std::string& error)
{
    std::string key;
    if (!stamp_file(key, path, error))
        return nullptr;
    if (PixelSourcePointer known = find_source(key))
        return known;
    auto image = std::make_shared<StoredImage>(key, path);
    return image->open(error) ? keep_source(image) : nullptr;
}

bool read_all(OIIO::ImageBuf& dst, PixelSource& source, std::string& error)
{
    OIIO::ImageSpec spec = source.spec();
    spec.set_format(OIIO::TypeFloat);
    dst.reset(spec, OIIO::InitializePixels::No);
    auto* pixels = static_cast<float*>(dst.localpixels());
    if (!pixels) {
        error = format("no memory for {}x{} pixels", spec.width, spec.height);
        return false;
    }
    if (auto* file = dynamic_cast<StoredImage*>(&source))
        return file->read_file(pixels, error);
    return source.read(OIIO::get_roi(spec), pixels, error);
}

} // namespace vmlight
