// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/albedo_source.h>

#include <vmlight/base/format.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/image/channels.h>
#include <vmlight/image/color.h>
#include <vmlight/stage/layer_source.h>
#include <vmlight/stage/source_cache.h>
#include <vmlight/stage/stored_image.h>

#include <algorithm>
#include <array>

namespace vmlight {

AlbedoSource::AlbedoSource(const std::string& key, const LightmapRecipe& recipe, PixelSourcePointer image,
                           const std::string& working, OIIO::ROI size)
    : PixelSource(key)
    , m_path(recipe.albedo)
    , m_color { recipe.colorconfig, recipe.albedo_colorspace, image->spec().format, working }
    , m_size(size)
    , m_image(std::move(image))
{
    m_spec = OIIO::ImageSpec(size.width(), size.height(), 3, OIIO::TypeFloat);
    OIIO::set_roi(m_spec, size);
}

std::shared_ptr<AlbedoSource> AlbedoSource::open(const LightmapRecipe& recipe, PixelSourcePointer image,
                                                 const std::string& config, const std::string& working, OIIO::ROI size,
                                                 std::string& error)
{
    std::array<int, 3> channels;
    if (!find_color_channels(image->spec(), channels, error)) {
        error = format("\"{}\": {}{}", recipe.albedo, error, layer_advice(recipe.albedo, "--albedo-layer"));
        return nullptr;
    }
    const std::string key = format("albedo\n{}\n{}\n{} {} {} {}\n{}", recipe.albedo_colorspace, working, size.xbegin,
                                   size.xend, size.ybegin, size.yend, config + image->key());
    if (auto known = std::dynamic_pointer_cast<AlbedoSource>(find_source(key)))
        return known;
    return std::dynamic_pointer_cast<AlbedoSource>(
        keep_source(std::make_shared<AlbedoSource>(key, recipe, std::move(image), working, size)));
}

const AlbedoReader* AlbedoSource::reader(std::string& error)
{
    return m_prepare.run([&](std::string& reason) { return prepare(reason); }, error) ? &m_reader : nullptr;
}

std::string AlbedoSource::conversion_note() const
{
    return vmlight::conversion_note(m_image->spec(), m_path, m_color);
}

bool AlbedoSource::prepare(std::string& error)
{
    std::string note;
    if (!read_all(m_pixels, *m_image, error) || !to_scene_linear(m_pixels, m_path, m_color, note, error, 1))
        return false;
    if (!m_reader.open(m_pixels, m_size, 1, error)) {
        error = format("\"{}\": {}", m_path, error);
        return false;
    }
    ++work_counts().albedos_made;
    const bool resized = m_pixels.roi().width() != m_size.width() || m_pixels.roi().height() != m_size.height();
    m_bytes = size_t(m_pixels.spec().image_bytes())
        + (resized ? sizeof(float) * size_t(m_size.npixels()) * size_t(m_pixels.nchannels()) : 0);
    return true;
}

bool AlbedoSource::make(std::vector<OIIO::ImageBuf>& dst, ImageRange, const MakeOptions& options, std::string& error)
{
    std::string note;
    std::vector<std::string> warnings;
    if (!m_image->make(dst, {}, options, error)
        || !to_scene_linear(dst[0], m_path, m_color, note, error, options.threads, &warnings))
        return false;
    for (const std::string& warning : warnings)
        options.report_warning(warning);
    options.report("albedo: " + note);
    return true;
}

bool AlbedoSource::read(OIIO::ROI roi, float* dst, std::string& error)
{
    const AlbedoReader* albedo = reader(error);
    if (!albedo)
        return false;
    std::fill_n(dst, 3 * size_t(roi.npixels()), 1.0f);
    std::vector<float> scratch;
    BadValues faults;
    albedo->multiply(roi, dst, scratch, faults, error);
    if (faults.any())
        error = albedo->fault_text(faults);
    return error.empty();
}

} // namespace vmlight
