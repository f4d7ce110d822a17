// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/surface_materials.h>

#include <vmlight/base/available_memory.h>
#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/image/color.h>
#include <vmlight/stage/material_image.h>
#include <vmlight/stage/material_texture.h>

#include <OpenImageIO/imagebufalgo.h>

#include <array>
#include <map>

namespace vmlight {
namespace {

using OIIO::ImageBuf;

class MaterialReader
{
public:
    MaterialReader(const std::string& light_space, const std::string& colorconfig, const MakeOptions& options)
        : m_settings { colorconfig, "", OIIO::TypeUInt8, light_space }
        , m_options(options)
    {
    }

    bool open(std::string& error) { return find_factor_conversion(m_convert, m_settings, error); }

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
        if (material.alpha_mode != AlphaMode::opaque && material.opacity_texture.exists()) {
            result.opacity = read_opacity(material.opacity_texture);
            result.opacity_transform = material.opacity_texture.uv_transform;
            result.opacity_uv_set = material.opacity_texture.uv_set;
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

    // Not shared: a material that has one has it alone as a rule.
    std::shared_ptr<const TexturePyramid> read_opacity(const MaterialTexture& texture)
    {
        MaterialImage image;
        std::string error;
        std::vector<float> texels;
        bool good = image.open(texture, error);
        if (good) {
            error = memory_shortage(image.spec());
            good = error.empty();
        }
        if (good) {
            texels.resize(size_t(image.spec().width) * size_t(image.spec().height));
            good = image.read(0, 1, texels.data(), error);
        }
        if (!good) {
            m_options.report_warning(error + "; the material's opacity is left out");
            return nullptr;
        }
        return std::make_shared<TexturePyramid>(image.spec().width, image.spec().height, 1, texels.data(), nullptr,
                                                wrap_of(texture.wrap_s), wrap_of(texture.wrap_t), m_options.threads);
    }

    std::shared_ptr<const TexturePyramid> make(const MaterialTexture& texture, std::string& error)
    {
        ImageBuf image;
        std::array<int, 3> index;
        if (!read_material_texture(image, index, texture, m_settings, m_options.threads, error))
            return nullptr;
        const OIIO::ImageSpec& spec = image.spec();
        const size_t count = size_t(spec.width) * size_t(spec.height), channels = size_t(spec.nchannels);
        std::vector<float> all(count * channels), rgba(count * 4);
        if (!image.get_pixels(image.roi(), OIIO::TypeFloat, all.data())) {
            error = format("\"{}\": {}", texture.path, oiio::error_line(image));
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
