// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/material_normals.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/mesh/selection.h>
#include <vmlight/stage/material_image.h>
#include <vmlight/uv/raster.h>
#include <vmlight/uv/udim.h>

#include <algorithm>
#include <cmath>

namespace vmlight {
namespace {

constexpr uint32_t kNoMaterial = ~0u;

// The material of each texel, row by row.
std::vector<uint32_t> materials_of_texels(const Mesh& mesh, Size size, int udim)
{
    std::vector<uint32_t> materials(size_t(size.width) * size_t(size.height), kNoMaterial);
    const UvRaster raster(mesh, size.width, size.height, udim);
    TileCover cover;
    for (int tile = 0; tile < raster.tiles_across() * raster.tiles_down(); ++tile) {
        raster.cover(tile, cover);
        const int left = tile % raster.tiles_across() * kTileSize, top = tile / raster.tiles_across() * kTileSize;
        for (int y = 0; y < std::min(kTileSize, size.height - top) && cover.covered > 0; ++y)
            for (int x = 0; x < std::min(kTileSize, size.width - left); ++x)
                if (const uint32_t t = cover.triangle[size_t(y * kTileSize + x)]; t < mesh.triangle_materials.size())
                    materials[size_t(top + y) * size_t(size.width) + size_t(left + x)] = mesh.triangle_materials[t];
    }
    return materials;
}

// Why the image is not in the UVs that are baked, or "".
std::string elsewhere(const MaterialTexture& texture, const VismapRecipe& recipe)
{
    if (texture.uv_set != recipe.mesh_params.uv_set)
        return format("in UV set {}, and set {} is baked", texture.uv_set, recipe.mesh_params.uv_set);
    if (texture.uv_transform != Imath::M33d())
        return "moved, scaled or turned in the UVs";
    const bool repeats = texture.wrap_s == "periodic" && texture.wrap_t == "periodic";
    if (recipe.vismap_params.udim != kFirstUdim && !repeats)
        return "not repeated beyond the first UDIM tile";
    return "";
}

bool read_texture(OIIO::ImageBuf& dst, const MaterialTexture& texture, std::vector<FileStamp>* files,
                  std::string& error)
{
    error = texture.missing;
    if (!error.empty())
        return false;
    FileStamp file { texture.path, "" };
    std::string ignored; // open() says it better
    if (files && !texture.path.empty() && stamp_file(file.stamp, file.path, ignored))
        files->push_back(std::move(file));
    constexpr int kColors = 3;
    return MaterialImage::read_all(dst, texture, kColors, error);
}

} // namespace

bool read_material_normals(NormalMap& dst, const VismapRecipe& recipe, const Mesh& mesh, int nthreads,
                           std::vector<std::string>& notes, std::vector<std::string>& warnings,
                           std::vector<FileStamp>* files, std::string& error)
{
    const Size size = recipe.vismap_params.size();
    const std::vector<uint32_t> chosen = materials_of_texels(mesh, size, recipe.vismap_params.udim);
    std::vector<bool> used(mesh.materials.size(), false);
    for (const uint32_t material : chosen)
        if (material < used.size())
            used[material] = true;
    NormalMapParams params = recipe.normal_map_params;
    params.normal_map_space = "tangent";
    size_t read = 0;
    dst.reset(size);
    for (size_t i = 0; i < used.size(); ++i) {
        const Material& material = mesh.materials[i];
        const MaterialTexture& texture = material.normal_texture;
        if (!used[i] || (!texture.exists() && texture.missing.empty()))
            continue;
        const std::string name = shortened_line(material_name(mesh, i));
        if (const std::string where = elsewhere(texture, recipe); !where.empty()) {
            warnings.push_back(format("material \"{}\": its normal map is {}: left out", name, where));
            continue;
        }
        OIIO::ImageBuf image;
        NormalMap part;
        std::vector<std::string> doubts;
        if (!read_texture(image, texture, files, error) || !part.decode(image, params, size, nthreads, doubts, error)) {
            error = format("material \"{}\": its normal map: {}", name, error);
            return false;
        }
        for (const std::string& doubt : doubts)
            warnings.push_back(format("material \"{}\": its normal map: {}", name, doubt));
        part.scale(material.normal_scale);
        dst.take(part, chosen, uint32_t(i));
        ++read;
    }
    dst.settle();
    notes.push_back(format("normal maps: of {}{}", count_text(int64_t(read), "material", "materials"),
                           dst.is_flat() ? ", flat, so that nothing changes: left out" : ""));
    return true;
}

} // namespace vmlight
