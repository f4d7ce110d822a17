// SPDX-License-Identifier: Apache-2.0
#include <vmlight/bake_scene.h>

#include <OpenImageIO/strutil.h>

namespace vmlight {

bool BakeScene::build(std::shared_ptr<const Mesh> mesh, const std::vector<Mesh>& occluders, int nthreads,
                      std::string& error)
{
    using OIIO::Strutil::fmt::format;
    const std::string& path = mesh->path.empty() ? mesh->name : mesh->path;
    if (mesh->triangles.empty()) {
        error = format("\"{}\": no triangle in it", path);
        return false;
    }
    if (mesh->uvs.empty()) {
        error = format("\"{}\": no texture coordinates: unwrap the mesh first, or choose another set of them", path);
        return false;
    }
    std::vector<const Mesh*> casters { mesh.get() };
    for (const Mesh& occluder : occluders)
        casters.push_back(&occluder);
    m_frame = SceneFrame::around(*mesh);
    if (!m_occluder.build(casters, m_frame, nthreads, error))
        return false;
    m_mesh_hash = vmlight::mesh_hash(*mesh);
    for (const Mesh& occluder : occluders)
        m_occluder_hashes += (m_occluder_hashes.empty() ? "" : ",") + vmlight::mesh_hash(occluder);
    for (const Mesh* caster : casters)
        m_triangles += int64_t(caster->triangles.size());
    m_mesh = std::move(mesh);
    return true;
}

size_t BakeScene::bytes() const
{
    // The ray tracer takes about 100 bytes a triangle.
    return 100 * size_t(m_triangles) + 20 * m_mesh->triangles.size() + 48 * m_mesh->positions.size();
}

} // namespace vmlight
