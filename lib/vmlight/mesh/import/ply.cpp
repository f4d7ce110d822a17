// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/unique_index.h>
#include <vmlight/mesh/import/format_checks.h>
#include <vmlight/mesh/import/ply.h>
#include <vmlight/mesh/import/polygons.h>
#include <vmlight/mesh/import/side_files.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <cmath>

namespace vmlight {
namespace {

using Imath::V2f;
using Imath::V3d;

// A function of its own, so that the bytes are freed before the mesh is built.
bool parse_ply(ply::File& dst, const ImportRequest& request, std::string& error)
{
    if (request.before_open)
        request.before_open(request.path);
    return ply::parse(dst, file_bytes(request.path), error);
}

void add_materials(MeshBuilder& dst, const ply::File& file, const std::string& folder)
{
    if (file.textures.empty())
        dst.add_material({});
    for (const std::string& texture : file.textures) {
        Material material;
        material.name = OIIO::Filesystem::filename(texture);
        material.base_color_texture.path = side_path(folder, texture);
        dst.add_material(std::move(material));
    }
}

class PlyAppender
{
public:
    PlyAppender(MeshBuilder& dst, const ply::File& file)
        : m_dst(dst)
        , m_file(file)
        , m_is_far(is_far_from_origin(file.exact_positions))
        , m_has_uvs(dst.params().uv_set == 0)
        , m_split(m_has_uvs ? file.corner_uvs.size() : 0)
    {
        if (m_is_far)
            dst.set_exact_positions();
        dst.reserve(file.positions.size(), file.ends.size());
        dst.begin_part("", dst.root_transform(false), dst.add_node("", -1));
        for (size_t i = 0; i < file.positions.size(); ++i)
            add_vertex(i, file.uvs.empty() ? nullptr : &file.uvs[i]);
    }

    bool is_far() const { return m_is_far; }
    V3d position(size_t vertex) const
    {
        return m_is_far ? m_file.exact_positions[vertex] : V3d(m_file.positions[vertex]);
    }

    void add_triangle(size_t face, const std::array<uint32_t, 3>& corners)
    {
        std::array<uint32_t, 3> vertices {};
        for (size_t k = 0; k < 3; ++k)
            vertices[k] = vertex_of(corners[k]);
        const int32_t texture = m_file.face_textures.empty() ? 0 : m_file.face_textures[face];
        m_dst.add_triangle(vertices, uint32_t(std::max(texture, 0)));
    }

private:
    struct Split
    {
        uint32_t vertex;
        V2f uv;
    };

    void add_vertex(size_t vertex, const V2f* uv)
    {
        m_dst.add_vertex(position(vertex), m_file.normals.empty() ? V3d(0) : V3d(m_file.normals[vertex]),
                         m_has_uvs ? uv : nullptr);
    }

    // The vertices of the file come first; those with texture coordinates of a corner follow.
    uint32_t vertex_of(uint32_t corner)
    {
        const uint32_t vertex = m_file.corners[corner];
        if (m_file.corner_uvs.empty() || !m_has_uvs)
            return vertex;
        const V2f& uv = m_file.corner_uvs[corner];
        if (std::isnan(uv.x))
            return vertex;
        const uint32_t index = m_split.index_of({ vertex, uv });
        if (index == m_split_count) {
            ++m_split_count;
            add_vertex(vertex, &uv);
        }
        return uint32_t(m_file.positions.size()) + index;
    }

    MeshBuilder& m_dst;
    const ply::File& m_file;
    const bool m_is_far, m_has_uvs;
    UniqueIndex<Split> m_split;
    size_t m_split_count = 0;
};

} // namespace

bool is_ply(const FileHead& head)
{
    return OIIO::Strutil::istarts_with(head.bytes, "ply");
}

bool append_ply(MeshBuilder& dst, const ply::File& file, const std::string& folder, std::string& error)
{
    // A PLY has no word for a hard edge. Programs that write UVs of corners cut them there.
    constexpr double kSeamAngle = 60;
    if (!file.corner_uvs.empty())
        dst.set_seam_angle(kSeamAngle);
    add_materials(dst, file, folder);
    PlyAppender appender(dst, file);
    return visit_triangles(
        file.ends, [&](uint32_t corner) { return appender.position(file.corners[corner]); }, appender.is_far(),
        [&](size_t face, const std::array<uint32_t, 3>& corners) { appender.add_triangle(face, corners); }, error);
}

bool read_ply(MeshBuilder& dst, const ImportRequest& request, std::string& error)
{
    ply::File file;
    return parse_ply(file, request, error) && append_ply(dst, file, OIIO::Filesystem::parent_path(request.path), error);
}

} // namespace vmlight
