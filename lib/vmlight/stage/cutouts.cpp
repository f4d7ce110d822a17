// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/cutouts.h>

#include <vmlight/base/available_memory.h>
#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/mesh/opacity.h>
#include <vmlight/mesh/selection.h>
#include <vmlight/stage/material_image.h>
#include <vmlight/stage/uv_sets.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

namespace vmlight {
namespace {

class TextureReader
{
public:
    explicit TextureReader(std::vector<FileStamp>* files)
        : m_files(files)
    {
    }

    // Append the alpha of a texture to the material's, if it has any. `by_alpha`: of the alpha channel, else of the
    // first.
    bool add(MaterialOpacity& dst, const MaterialTexture& texture, bool by_alpha, std::string& error)
    {
        error = texture.missing;
        if (!error.empty())
            return false;
        if (!texture.exists())
            return true;
        const std::string key
            = format("{}\n{} {} {} {} {} {} {}", texture.path, texture.offset, texture.length, texture.wrap_s,
                     texture.wrap_t, texture.is_nearest, by_alpha, uint64_t(uintptr_t(texture.embedded.get())));
        const auto known = m_images.find(key);
        std::shared_ptr<const AlphaTexture> image;
        if (known != m_images.end())
            image = known->second;
        else if (!read(image, texture, by_alpha, error))
            return false;
        m_images[key] = image;
        if (image)
            (dst.textures[0].image ? dst.textures[1] : dst.textures[0])
                = { image, texture.uv_transform, texture.uv_set };
        return true;
    }

private:
    // nullptr if it is 1 everywhere.
    bool read(std::shared_ptr<const AlphaTexture>& dst, const MaterialTexture& texture, bool by_alpha,
              std::string& error)
    {
        FileStamp file { texture.path, "" };
        std::string ignored; // open() says it better
        if (m_files && !texture.path.empty() && stamp_file(file.stamp, file.path, ignored))
            m_files->push_back(std::move(file));
        MaterialImage image;
        if (!image.open(texture, error))
            return false;
        OIIO::ImageSpec spec = image.spec();
        const int channel = by_alpha ? spec.alpha_channel : 0;
        if (channel < 0 || channel >= spec.nchannels)
            return true;
        spec.nchannels = 1;
        error = memory_shortage(spec);
        if (error.empty() && (spec.depth > 1 || spec.width < 1 || spec.height < 1))
            error = format("{}x{}x{} pixels; a texture is flat", spec.width, spec.height, spec.depth);
        if (!error.empty()) {
            error = format("\"{}\": {}", texture.path, error);
            return false;
        }
        std::vector<float> texels(size_t(spec.width) * size_t(spec.height));
        if (!image.read(channel, channel + 1, texels.data(), error))
            return false;
        ++work_counts().alphas_read;
        auto alpha = std::make_shared<AlphaTexture>(spec.width, spec.height, std::move(texels), wrap_of(texture.wrap_s),
                                                    wrap_of(texture.wrap_t), texture.is_nearest);
        if (alpha->range().low < 1)
            dst = std::move(alpha);
        return true;
    }

    std::vector<FileStamp>* m_files;
    std::map<std::string, std::shared_ptr<const AlphaTexture>> m_images;
};

// Materials that triangles have, of those that are not opaque by their word alone.
std::vector<bool> used_cutouts(const Mesh& mesh)
{
    std::vector<bool> used(mesh.materials.size(), false);
    for (const uint32_t material : mesh.triangle_materials)
        if (material < used.size() && mesh.materials[material].alpha_mode != AlphaMode::opaque)
            used[material] = true;
    return used;
}

float usable_factor(float alpha)
{
    return std::isnan(alpha) ? 1 : std::clamp(alpha, 0.0f, 1.0f);
}

} // namespace

bool read_cutouts(Mesh& mesh, const CutoutSource& source, std::vector<FileStamp>* files, std::string& error)
{
    mesh.opacity = nullptr;
    const std::vector<bool> used = used_cutouts(mesh);
    if (std::find(used.begin(), used.end(), true) == used.end())
        return true;
    auto opacity = std::make_shared<MeshOpacity>();
    opacity->materials.resize(mesh.materials.size());
    TextureReader textures(files);
    std::vector<int> sets;
    bool is_cut_out = false;
    for (size_t i = 0; i < used.size(); ++i) {
        if (!used[i])
            continue;
        const Material& material = mesh.materials[i];
        MaterialOpacity read {
            material.alpha_mode, double(material.alpha_cutoff), double(usable_factor(material.base_color.a)), {}
        };
        if (!textures.add(read, material.base_color_texture, true, error)
            || !textures.add(read, material.opacity_texture, false, error)) {
            error
                = format("\"{}\": material \"{}\" needs the alpha of its texture: {}; fix it, or take all surfaces as "
                         "opaque with --cutouts off",
                         mesh.path.empty() ? mesh.name : mesh.path, shortened_line(material_name(mesh, i)), error);
            return false;
        }
        if (read.is_opaque())
            continue;
        for (const MaterialOpacity::Texture& texture : read.textures)
            if (texture.image)
                sets.push_back(texture.uv_set);
        opacity->materials[i] = std::move(read);
        is_cut_out = true;
    }
    if (!is_cut_out)
        return true;
    opacity->uvs = other_uvs(mesh, sets, source.uv_set, source.loses_uvs, source.read_again);
    mesh.opacity = std::move(opacity);
    return true;
}

std::string cutout_line(const CutoutCounts& counts)
{
    if (counts.triangles == 0)
        return "";
    const double share = counts.cells ? 100.0 * double(counts.unknown) / double(counts.cells) : 0;
    return format("cut-outs: {}, {} opaque, {} transparent, {} in part: {:.3g} % of their cells need the texture; "
                  "{:.1f} MB",
                  count_text(counts.triangles, "triangle", "triangles"), counts.opaque, counts.transparent,
                  counts.mixed, share, double(counts.bytes) * 1e-6);
}

std::string cutout_warning(const CutoutCounts& counts)
{
    if (counts.triangles == 0 || counts.transparent < counts.triangles)
        return "";
    return format("cut-outs: {} with a material that says so {} transparent everywhere and {} no light; if that is not "
                  "meant, take all surfaces as opaque with --cutouts off",
                  count_text(counts.triangles, "triangle", "triangles"), plural(counts.triangles, "is", "are"),
                  plural(counts.triangles, "stops", "stop"));
}

} // namespace vmlight
