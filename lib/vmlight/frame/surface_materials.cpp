// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/surface_materials.h>

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/image/channels.h>
#include <vmlight/image/color.h>
#include <vmlight/image/image_file.h>
#include <vmlight/image/primaries.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <array>
#include <map>

namespace vmlight {
namespace {

using OIIO::ImageBuf;

// Image files that OIIO reads from memory, by how they begin.
struct ImageFormat
{
    const char *begins, *name;
};
constexpr std::array<ImageFormat, 3> kEmbeddedFormats {
    { { "\x89PNG", "texture.png" }, { "\xff\xd8\xff", "texture.jpg" }, { "\x76\x2f\x31\x01", "texture.exr" } }
};

bool read_bytes(std::string& dst, const MaterialTexture& texture, std::string& error)
{
    if (texture.embedded) {
        dst = *texture.embedded;
        return true;
    }
    dst.resize(texture.length);
    if (OIIO::Filesystem::read_bytes(texture.path, dst.data(), dst.size(), texture.offset) == dst.size())
        return true;
    error = format("\"{}\": cannot read the texture in it", texture.path);
    return false;
}

bool read_embedded(ImageBuf& dst, const MaterialTexture& texture, std::string& error)
{
    std::string bytes;
    if (!read_bytes(bytes, texture, error))
        return false;
    const auto format_of
        = std::find_if(kEmbeddedFormats.begin(), kEmbeddedFormats.end(), [&](const ImageFormat& format) {
              return bytes.compare(0, std::char_traits<char>::length(format.begins), format.begins) == 0;
          });
    if (format_of == kEmbeddedFormats.end()) {
        error = format("\"{}\": a texture in it is neither PNG, JPEG nor EXR", texture.path);
        return false;
    }
    OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    const auto in = OIIO::ImageInput::open(format_of->name, &config, &memory);
    if (!in) {
        error = format("\"{}\": a texture in it: {}", texture.path, OIIO::geterror());
        return false;
    }
    OIIO::ImageSpec spec = in->spec();
    error = header_fault(spec);
    if (!error.empty())
        return false;
    const OIIO::TypeDesc stored = spec.format;
    spec.set_format(OIIO::TypeFloat);
    dst.reset(spec);
    if (!in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, dst.localpixels())) {
        error = format("\"{}\": a texture in it: {}", texture.path, oiio::error_line(*in));
        return false;
    }
    dst.specmod().attribute("vmlight:stored", int(stored.basetype));
    return true;
}

TextureWrap wrap_of(const std::string& word)
{
    return word == "clamp" ? TextureWrap::clamp : word == "mirror" ? TextureWrap::mirror : TextureWrap::periodic;
}

class MaterialReader
{
public:
    MaterialReader(const std::string& light_space, const std::string& colorconfig, const MakeOptions& options)
        : m_settings { colorconfig, "", OIIO::TypeUInt8, light_space }
        , m_options(options)
    {
    }

    // The conversion of factors: linear, Rec.709 primaries.
    bool open(std::string& error)
    {
        OIIO::ImageSpec spec(1, 1, 3, OIIO::TypeFloat);
        tag_scene_linear(spec, "lin_rec709_scene");
        ColorSettings settings = m_settings;
        settings.stored = OIIO::TypeFloat;
        std::string note;
        return describe_scene_linear(spec, m_convert, "", settings, note, error);
    }

    SurfaceMaterial read(const Material& material)
    {
        SurfaceMaterial result;
        result.color = { material.base_color.r, material.base_color.g, material.base_color.b };
        if (m_convert)
            m_convert(&result.color.x, 1);
        result.alpha = material.base_color.a;
        result.alpha_mode = material.alpha_mode;
        result.alpha_cutoff = material.alpha_cutoff;
        if (material.base_color_texture.exists()) {
            result.texture = share(material.base_color_texture);
            result.uv_transform = material.base_color_texture.uv_transform;
            result.uv_set = material.base_color_texture.uv_set;
        }
        return result;
    }

private:
    // Materials often share a texture.
    std::shared_ptr<const TexturePyramid> share(const MaterialTexture& texture)
    {
        const std::string key
            = format("{}\n{} {} {} {} {}", texture.path, texture.offset, texture.length, texture.wrap_s, texture.wrap_t,
                     uint64_t(texture.embedded ? uintptr_t(texture.embedded.get()) : 0));
        const auto known = m_textures.find(key);
        if (known != m_textures.end())
            return known->second;
        std::string error;
        auto pyramid = make(texture, error);
        if (!pyramid)
            m_options.report_warning(error + "; the material's texture is left out");
        return m_textures[key] = pyramid;
    }

    std::shared_ptr<const TexturePyramid> make(const MaterialTexture& texture, std::string& error)
    {
        ImageBuf image;
        const bool is_file = !texture.embedded && texture.length == 0;
        if (!(is_file ? read_image(image, texture.path, error) : read_embedded(image, texture, error)))
            return nullptr;
        ColorSettings settings = m_settings;
        settings.stored = is_file
            ? image.nativespec().format
            : OIIO::TypeDesc(OIIO::TypeDesc::BASETYPE(image.spec().get_int_attribute("vmlight:stored")));
        std::array<int, 3> index;
        std::string note;
        if (!find_color_channels(image.spec(), index, error)
            || !to_scene_linear(image, is_file ? texture.path : "", settings, note, error, m_options.threads)) {
            error = format("\"{}\": {}", texture.path, error);
            return nullptr;
        }
        const OIIO::ImageSpec& spec = image.spec();
        const size_t count = size_t(spec.width) * size_t(spec.height), channels = size_t(spec.nchannels);
        std::vector<float> all(count * channels), rgba(count * 4);
        if (!image.get_pixels(image.roi(), OIIO::TypeFloat, all.data())) {
            error = format("\"{}\": {}", texture.path, image.geterror());
            return nullptr;
        }
        for (size_t i = 0; i < count; ++i) {
            for (size_t c = 0; c < 3; ++c)
                rgba[i * 4 + c] = all[i * channels + size_t(index[c])];
            rgba[i * 4 + 3] = spec.alpha_channel >= 0 ? all[i * channels + size_t(spec.alpha_channel)] : 1;
        }
        return std::make_shared<TexturePyramid>(spec.width, spec.height, 4, rgba.data(), nullptr,
                                                wrap_of(texture.wrap_s), wrap_of(texture.wrap_t), m_options.threads);
    }

    const ColorSettings m_settings;
    const MakeOptions& m_options;
    ColorConversion m_convert;
    std::map<std::string, std::shared_ptr<const TexturePyramid>> m_textures;
};

} // namespace

bool read_materials(std::vector<SurfaceMaterial>& dst, const Mesh& mesh, const std::string& light_space,
                    const std::string& colorconfig, const MakeOptions& options, std::string& error)
{
    dst.clear();
    MaterialReader reader(light_space, colorconfig, options);
    if (!reader.open(error))
        return false;
    for (const Material& material : mesh.materials)
        dst.push_back(reader.read(material));
    return true;
}

} // namespace vmlight
