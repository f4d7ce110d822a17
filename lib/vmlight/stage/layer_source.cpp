// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/layer_source.h>

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/base/params.h>
#include <vmlight/image/channels.h>
#include <vmlight/image/image_file.h>
#include <vmlight/stage/source_cache.h>
#include <vmlight/stage/stored_image.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace vmlight {
namespace {

/// Some channels of another source.
class LayerSource : public PixelSource
{
public:
    LayerSource(const std::string& key, PixelSourcePointer image, const std::array<int, 3>& channels)
        : PixelSource(key)
        , m_image(std::move(image))
        , m_channels(channels)
    {
        m_spec = m_image->spec();
        m_spec.nchannels = 3;
        m_spec.channelnames = { "R", "G", "B" };
        m_spec.channelformats.clear();
        m_spec.alpha_channel = m_spec.z_channel = -1;
    }

    bool read(OIIO::ROI roi, float* dst, std::string& error) override
    {
        const size_t pixels = size_t(roi.width()) * roi.height();
        std::vector<float> read(pixels * size_t(m_image->spec().nchannels));
        if (!m_image->read(roi, read.data(), error))
            return false;
        pick(read.data(), dst, pixels);
        return true;
    }

    bool make(std::vector<OIIO::ImageBuf>& dst, ImageRange range, const MakeOptions& options,
              std::string& error) override
    {
        if (!m_image->make(dst, range, options, error))
            return false;
        OIIO::ImageSpec spec = m_spec;
        spec.set_format(OIIO::TypeFloat);
        for (OIIO::ImageBuf& image : dst) {
            OIIO::ImageBuf layer(image.name(), spec, OIIO::InitializePixels::No);
            if (!layer.localpixels()) {
                error = format("out of memory for {}x{} pixels", spec.width, spec.height);
                return false;
            }
            pick(static_cast<const float*>(image.localpixels()), static_cast<float*>(layer.localpixels()),
                 size_t(spec.image_pixels()));
            image = std::move(layer);
        }
        return true;
    }

    bool failed() const override { return m_image->failed(); }
    size_t bytes() const override { return m_image->bytes(); }

private:
    void pick(const float* from, float* to, size_t pixels) const
    {
        for (const float* end = to + 3 * pixels; to != end; from += m_image->spec().nchannels)
            for (int channel : m_channels)
                *to++ = from[channel];
    }

    const PixelSourcePointer m_image;
    const std::array<int, 3> m_channels;
};

struct Part
{
    std::string name;
    OIIO::ImageSpec spec;
};

bool read_parts(std::vector<Part>& parts, const std::string& path, std::string& error)
{
    const auto file = open_image(path, error);
    if (!file)
        return false;
    for (int i = 0; file->seek_subimage(i, 0); ++i)
        parts.push_back({ file->spec().get_string_attribute("oiio:subimagename"), file->spec() });
    return true;
}

bool find_layer(const Part& part, const std::string& layer, std::array<int, 3>& channels)
{
    std::string ignored;
    const std::string start = part.name + ".";
    if (find_layer_channels(part.spec, layer, channels)
        || (part.name == layer && find_color_channels(part.spec, channels, ignored))
        || (!part.name.empty() && OIIO::Strutil::starts_with(layer, start)
            && find_layer_channels(part.spec, layer.substr(start.size()), channels)))
        return true;
    if (part.name != layer)
        return false;
    // "ViewLayer.Combined" of channels "Combined.R".
    const std::vector<std::string> own = color_layers(part.spec);
    const auto is_end = [&](const std::string& name) { return OIIO::Strutil::ends_with(layer, "." + name); };
    const auto found = std::find_if(own.begin(), own.end(), is_end);
    return found != own.end() && find_layer_channels(part.spec, *found, channels);
}

std::vector<std::string> all_layers(const std::vector<Part>& parts)
{
    std::vector<std::string> names;
    const auto add = [&](const std::string& name) {
        if (std::find(names.begin(), names.end(), name) == names.end())
            names.push_back(name);
    };
    for (const Part& part : parts) {
        std::array<int, 3> ignored;
        if (!part.name.empty() && find_layer(part, part.name, ignored))
            add(part.name);
        for (const std::string& layer : color_layers(part.spec))
            add(layer);
    }
    return names;
}

} // namespace

PixelSourcePointer open_layer(const std::string& path, const std::string& layer, std::string& error)
{
    std::vector<Part> parts;
    if (!may_be_image(path))
        return open_stored_image(path, error); // its reason
    if (!read_parts(parts, path, error))
        return nullptr;
    for (size_t i = 0; i < parts.size(); ++i) {
        std::array<int, 3> channels;
        if (!find_layer(parts[i], layer, channels))
            continue;
        const PixelSourcePointer image = open_stored_image(path, error, int(i));
        if (!image)
            return nullptr;
        const std::string key = format("layer {}\n", layer) + image->key();
        if (PixelSourcePointer known = find_source(key))
            return known;
        return keep_source(std::make_shared<LayerSource>(key, image, channels));
    }
    const std::vector<std::string> names = all_layers(parts);
    const std::string near = nearest_name(layer, names);
    error = format("\"{}\": no layer \"{}\" with colour; {}", path, layer,
                   names.empty()      ? "it has no layers"
                       : near.empty() ? "it has " + OIIO::Strutil::join(names, ", ")
                                      : "did you mean \"" + near + "\"?");
    return nullptr;
}

std::string layer_advice(const std::string& path, const char* flag)
{
    std::vector<Part> parts;
    std::string ignored;
    if (!read_parts(parts, path, ignored) || parts.size() < 2)
        return "";
    const std::vector<std::string> names = all_layers(parts);
    return names.empty() ? "" : format("; choose a layer with {}: {}", flag, OIIO::Strutil::join(names, ", "));
}

} // namespace vmlight
