// SPDX-License-Identifier: Apache-2.0
#include <vmlight/pixel_source.h>

#include <vmlight/mesh.h>
#include <vmlight/stage_counts.h>
#include <vmlight/vismap_baker.h>
#include <vmlight/vismap_tiles.h>

#include <OpenImageIO/filesystem.h>

#include <memory>

namespace vmlight {
namespace {

class VismapSource : public PixelSource
{
public:
    VismapSource(const std::string& key, const VismapRecipe& recipe, std::vector<std::string> stamps)
        : PixelSource(key)
        , m_recipe(recipe)
        , m_stamps(std::move(stamps))
    {
        // The mesh's hash would take the mesh to know; a map that is made from the mesh as it is needs none.
        m_spec = describe_vismap(OIIO::Filesystem::filename(recipe.mesh), recipe.vismap_params);
        append_params(m_spec, recipe.mesh_params);
    }

    bool read(OIIO::ROI roi, float* dst, std::string& error) override
    {
        if (!m_prepare.run([&](std::string& reason) { return prepare(reason); }, error))
            return false;
        m_tiles->read(roi, dst);
        return true;
    }

    bool failed() const override { return m_prepare.failed(); }
    size_t bytes() const override { return m_bytes; }

private:
    bool prepare(std::string& error)
    {
        std::vector<Mesh> occluders(m_recipe.occluder.size());
        if (!read_mesh(m_mesh, m_recipe.mesh, m_recipe.mesh_params, error)
            || !check_stamp(m_stamps.front(), m_recipe.mesh, error))
            return false;
        for (size_t i = 0; i < occluders.size(); ++i)
            if (!read_mesh(occluders[i], m_recipe.occluder[i], m_recipe.mesh_params, error)
                || !check_stamp(m_stamps[i + 1], m_recipe.occluder[i], error))
                return false;
        stage_counts().meshes_read += int64_t(1 + occluders.size());
        if (!m_baker.prepare(m_mesh, occluders, m_recipe.vismap_params, 0, error))
            return false;
        m_tiles = std::make_unique<VismapTiles>(m_baker, m_recipe.vismap_params.margin);
        // The ray tracer takes about 100 bytes a triangle.
        size_t triangles = m_mesh.triangles.size();
        for (const Mesh& occluder : occluders)
            triangles += occluder.triangles.size();
        m_bytes = 100 * triangles + 20 * m_mesh.triangles.size() + 48 * m_mesh.positions.size();
        if (m_tiles->is_whole())
            m_bytes += size_t(m_spec.image_bytes());
        return true;
    }

    const VismapRecipe m_recipe;
    const std::vector<std::string> m_stamps;
    Once m_prepare;
    Mesh m_mesh;
    VismapBaker m_baker;
    std::unique_ptr<VismapTiles> m_tiles;
    std::atomic<size_t> m_bytes { 0 };
};

} // namespace

PixelSourcePointer open_source(const VismapRecipe& recipe, std::string& error, const RecipeChain& chain)
{
    error = recipe_fault(recipe, chain);
    if (!error.empty() || !check_params(recipe.vismap_params, error) || !check_params(recipe.mesh_params, error))
        return nullptr;
    std::vector<std::string> stamps(1 + recipe.occluder.size());
    std::string key = recipe_key(recipe);
    for (size_t i = 0; i < stamps.size(); ++i) {
        if (!stamp_file(stamps[i], i ? recipe.occluder[i - 1] : recipe.mesh, error)) {
            error = placed(recipe, i ? "occluder" : "mesh", chain, error);
            return nullptr;
        }
        key += stamps[i];
    }
    if (PixelSourcePointer known = find_source(key))
        return known;
    return keep_source(std::make_shared<VismapSource>(key, recipe, std::move(stamps)));
}

} // namespace vmlight
