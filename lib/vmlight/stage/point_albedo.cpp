// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/point_albedo.h>

#include <vmlight/base/work_counts.h>
#include <vmlight/image/color.h>
#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/mesh/texture_wrap.h>
#include <vmlight/stage/material_texture.h>
#include <vmlight/uv/udim.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace vmlight {
namespace {

using Imath::V2d;
using Imath::V3d;
using Imath::V3f;

// Cells are larger than details of a texture.
constexpr int kMostAlbedoTexels = 64;

// A texture, as blocks of its mean colour.
class ColorBlocks
{
public:
    ColorBlocks(const OIIO::ImageBuf& image, const std::array<int, 3>& index, const MaterialTexture& texture)
        : m_texture(texture)
        , m_width(std::min(kMostAlbedoTexels, image.spec().width))
        , m_height(std::min(kMostAlbedoTexels, image.spec().height))
        , m_colors(size_t(m_width) * size_t(m_height))
    {
        std::vector<V3d> sums(m_colors.size(), V3d(0));
        std::vector<double> counts(m_colors.size());
        V3d sum(0);
        double count = 0;
        const OIIO::ImageSpec& spec = image.spec();
        for (OIIO::ImageBuf::ConstIterator<float> pixel(image); !pixel.done(); ++pixel) {
            const int64_t x = int64_t(pixel.x() - spec.x) * m_width / spec.width,
                          y = int64_t(pixel.y() - spec.y) * m_height / spec.height;
            const size_t block = size_t(y * m_width + x);
            const V3d color(pixel[index[0]], pixel[index[1]], pixel[index[2]]);
            if (!std::isfinite(color.x + color.y + color.z))
                continue;
            sums[block] += color;
            ++counts[block];
            sum += color;
            ++count;
        }
        m_mean = V3f(sum / std::max(1.0, count));
        for (size_t i = 0; i < m_colors.size(); ++i)
            m_colors[i] = counts[i] > 0 ? V3f(sums[i] / counts[i]) : m_mean;
    }

    V3f mean() const { return m_mean; }
    V3f at(const V2d& uv) const
    {
        V2d st;
        m_texture.uv_transform.multVecMatrix(uv, st);
        if (!(std::abs(st.x) < 1e9 && std::abs(st.y) < 1e9))
            return m_mean;
        const int x = wrapped_texel(int64_t(std::floor(st.x * m_width)), m_width, wrap_of(m_texture.wrap_s));
        const int y = wrapped_texel(int64_t(std::floor((1 - st.y) * m_height)), m_height, wrap_of(m_texture.wrap_t));
        return m_colors[size_t(y) * size_t(m_width) + size_t(x)];
    }

private:
    MaterialTexture m_texture;
    int m_width, m_height;
    std::vector<V3f> m_colors;
    V3f m_mean { 0 };
};

struct MaterialColor
{
    V3f factor { 1 };
    std::optional<ColorBlocks> texture;
    bool is_given = false; // by the file
    bool has_uvs = false; // those of the texture are those that are read
};

V2d uv_of(const Mesh& mesh, const LightPoint& point)
{
    const auto& [a, b, c] = mesh.triangles[point.triangle];
    const V2d first(mesh.uvs[a]);
    return first + (V2d(mesh.uvs[b]) - first) * double(point.u) + (V2d(mesh.uvs[c]) - first) * double(point.v);
}

// White is what a material has that says nothing of its colour.
bool has_color(const Material& material)
{
    const auto& color = material.base_color;
    return material.base_color_texture.exists() || color.r != 1 || color.g != 1 || color.b != 1;
}

V3f non_negative(const V3f& color)
{
    return { std::max(0.0f, color.x), std::max(0.0f, color.y), std::max(0.0f, color.z) };
}

class CasterColors
{
public:
    bool read(const std::string& path, const MeshParams& params, const ColorSettings& settings, const V3f& otherwise,
              const MakeOptions& options, std::vector<FileStamp>& files, std::string& error)
    {
        ColorConversion convert;
        ++work_counts().meshes_read;
        if (!read_mesh(m_mesh, path, params, error, [&](const std::string& opened) { note_file(files, opened); })
            || !find_factor_conversion(convert, settings, error))
            return false;
        std::vector<bool> used(m_mesh.materials.size());
        for (const uint32_t material : m_mesh.triangle_materials)
            if (material < used.size())
                used[material] = true;
        m_otherwise = otherwise;
        m_materials.resize(used.size());
        for (size_t i = 0; i < used.size(); ++i) {
            const Material& material = m_mesh.materials[i];
            MaterialColor& color = m_materials[i];
            if (!used[i])
                continue;
            color.is_given = has_color(material);
            if (!color.is_given)
                continue;
            color.factor = { material.base_color.r, material.base_color.g, material.base_color.b };
            if (convert)
                convert(&color.factor.x, 1);
            const MaterialTexture& texture = material.base_color_texture;
            OIIO::ImageBuf image;
            std::array<int, 3> index;
            std::string reason = texture.missing;
            if (!texture.path.empty())
                note_file(files, texture.path);
            if (texture.exists() && read_material_texture(image, index, texture, settings, options.threads, reason))
                color.texture.emplace(image, index, texture);
            else if (!reason.empty())
                options.report_warning(reason + "; bounced light leaves the texture out");
            color.has_uvs = texture.uv_set == params.uv_set && !m_mesh.uvs.empty();
        }
        return true;
    }

    // `is_given`: by the file.
    V3f at(const LightPoint& point, bool& is_given) const
    {
        const size_t triangle = point.triangle;
        const uint32_t material
            = triangle < m_mesh.triangle_materials.size() ? m_mesh.triangle_materials[triangle] : ~0u;
        if (material >= m_materials.size() || !m_materials[material].is_given) {
            is_given = false;
            return m_otherwise;
        }
        is_given = true;
        const MaterialColor& color = m_materials[material];
        if (!color.texture)
            return non_negative(color.factor);
        return non_negative(color.factor
                            * (color.has_uvs ? color.texture->at(uv_of(m_mesh, point)) : color.texture->mean()));
    }

private:
    Mesh m_mesh;
    V3f m_otherwise { 0 };
    std::vector<MaterialColor> m_materials;
};

} // namespace

void PointAlbedo::find(const MapScene& scene, const std::vector<LightPoint>& points, const V3f& ground,
                       const CasterColor& color)
{
    m_sources.clear();
    m_files.clear();
    for (const LightPoint& point : points) {
        if (point.caster == LightPoint::kGround)
            m_sources.push_back({ Source::kColor, ground });
        else if (point.caster == BakeScene::kWhole)
            m_sources.push_back({ texel_of(scene, point) });
        else
            m_sources.push_back({ Source::kColor, non_negative(color(point)) });
    }
}

int PointAlbedo::texel_of(const MapScene& scene, const LightPoint& point)
{
    if (point.caster != BakeScene::kWhole || point.triangle == LightPoint::kOtherPart)
        return Source::kMean;
    const Size size = scene.params().size();
    const V2d uv = uv_of(scene.scene()->mesh(), point) - V2d(udim_corner(scene.params().udim));
    const double x = uv.x * size.width, y = (1 - uv.y) * size.height;
    const bool is_on_map = x >= 0 && x < size.width && y >= 0 && y < size.height;
    return is_on_map ? int(y) * size.width + int(x) : Source::kMean;
}

bool PointAlbedo::read(const MapScene& scene, const std::vector<LightPoint>& points, const LightmapRecipe& recipe,
                       const std::string& space, const MakeOptions& options, std::string& error)
{
    const VismapRecipe& bake = scene.recipe();
    // What is not chosen of the mesh may be an occluder before those of the recipe: its albedo is the mesh's.
    const int before = int(scene.scene()->reach().size()) - int(bake.occluder.size());
    const ColorSettings settings { recipe.colorconfig, "", OIIO::TypeUInt8, space };
    const V3f ground(float(recipe.bounce_params.ground_albedo)), otherwise(float(recipe.bounce_params.bounce_albedo));
    std::vector<std::optional<CasterColors>> casters(bake.occluder.size());
    m_uses_bounce_albedo = false;
    m_sources.clear();
    m_files.clear();
    for (const LightPoint& point : points) {
        const int occluder = point.caster - before;
        if (point.caster == LightPoint::kGround) {
            m_sources.push_back({ Source::kColor, ground });
            continue;
        }
        if (occluder < 0) {
            m_sources.push_back({ texel_of(scene, point) });
            continue;
        }
        auto& caster = casters[size_t(occluder)];
        if (!caster
            && !caster.emplace().read(bake.occluder[size_t(occluder)], bake.mesh_params, settings, otherwise, options,
                                      m_files, error))
            return false;
        bool is_given;
        m_sources.push_back({ Source::kColor, caster->at(point, is_given) });
        m_uses_bounce_albedo = m_uses_bounce_albedo || !is_given;
    }
    return true;
}

void PointAlbedo::multiply(std::vector<float>& light, const std::vector<float>& albedo, const LightTransport& map) const
{
    const auto at = [&](size_t texel) { return V3f(albedo[3 * texel], albedo[3 * texel + 1], albedo[3 * texel + 2]); };
    V3d mean(0);
    double covered = 0;
    const bool needs_mean = std::any_of(m_sources.begin(), m_sources.end(),
                                        [](const Source& source) { return source.texel == Source::kMean; });
    for (size_t i = 0; needs_mean && i < albedo.size() / 3; ++i)
        if (map.is_covered(i)) {
            mean += V3d(at(i));
            ++covered;
        }
    mean /= std::max(1.0, covered);
    for (size_t i = 0; i < m_sources.size(); ++i) {
        const Source& source = m_sources[i];
        const V3f color = source.texel == Source::kColor ? source.color
            : source.texel == Source::kMean              ? V3f(mean)
                                                         : at(size_t(source.texel));
        for (size_t c = 0; c < 3; ++c)
            light[3 * i + c] *= color[int(c)];
    }
}

} // namespace vmlight
