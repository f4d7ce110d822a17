// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/ply_rows.h>

#include <vmlight/base/parallel_blocks.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>

namespace vmlight::ply {

using Imath::V2f;
using Imath::V3d;
using Imath::V3f;

std::optional<EvenRows> EvenRows::find(const Element& element, const Body& body)
{
    constexpr double kMostNumbers = 255; // of a list that is worth it
    EvenRows rows;
    if (!body.is_binary() || element.count == 0)
        return {};
    rows.m_body = &body;
    rows.m_count = element.count;
    for (const Property& property : element.properties) {
        Place place { property.type, rows.m_stride, 1 };
        if (property.count) {
            if (body.left() < rows.m_stride + property.count->bytes)
                return {};
            const double length = body.number_at(*property.count, rows.m_stride).value;
            if (!(length >= 0 && length <= kMostNumbers && length == double(size_t(length))))
                return {};
            place.offset += property.count->bytes;
            place.length = size_t(length);
        }
        rows.m_stride = place.offset + place.length * property.type->bytes;
        rows.m_places.push_back(place);
    }
    const bool fits = rows.m_stride > 0 && rows.m_count <= body.left() / rows.m_stride;
    return fits && rows.have_equal_lists(element) ? std::optional(std::move(rows)) : std::nullopt;
}

bool EvenRows::have_equal_lists(const Element& element) const
{
    std::atomic<bool> good { true };
    for (size_t i = 0; i < m_places.size(); ++i) {
        const Type* count = element.properties[i].count;
        if (!count)
            continue;
        const char* first = m_body->here() + m_places[i].offset - count->bytes;
        parallel_blocks(m_count, [&](size_t begin, size_t end, size_t) {
            for (size_t row = begin; row < end && good; ++row)
                if (std::memcmp(first + row * m_stride, first, count->bytes) != 0)
                    good = false;
        });
    }
    return good;
}

void read_vertices(File& dst, const EvenRows& rows, const Roles& roles, const VertexParts& parts)
{
    dst.positions.resize(rows.count());
    dst.exact_positions.resize(parts.has_doubles ? rows.count() : 0);
    dst.normals.resize(parts.has_normals ? rows.count() : 0);
    dst.uvs.resize(parts.has_uvs ? rows.count() : 0);
    parallel_blocks(rows.count(), [&](size_t begin, size_t end, size_t) {
        std::array<TextNumber, 8> n;
        for (size_t row = begin; row < end; ++row) {
            for (size_t i = 0; i < roles.size(); ++i)
                if (roles[i] <= kV)
                    n[roles[i]] = rows.number(row, rows.places()[i]);
            dst.positions[row] = V3f(n[kX].rounded, n[kY].rounded, n[kZ].rounded);
            if (parts.has_doubles)
                dst.exact_positions[row] = V3d(n[kX].value, n[kY].value, n[kZ].value);
            if (parts.has_normals)
                dst.normals[row] = V3f(n[kNormalX].rounded, n[kNormalY].rounded, n[kNormalZ].rounded);
            if (parts.has_uvs)
                dst.uvs[row] = V2f(n[kU].rounded, n[kV].rounded);
        }
    });
}

bool read_faces(File& dst, const EvenRows& rows, const Roles& roles, size_t vertex_count)
{
    const auto last = std::find(roles.rbegin(), roles.rend(), kCorners);
    if (last == roles.rend())
        return false;
    const EvenRows::Place place = rows.places()[size_t(roles.rend() - last) - 1];
    const size_t first = dst.corners.size(), first_face = dst.ends.size();
    dst.corners.resize(first + rows.count() * place.length);
    dst.ends.resize(first_face + rows.count());
    std::atomic<bool> good { true };
    parallel_blocks(rows.count(), [&](size_t begin, size_t end, size_t) {
        for (size_t row = begin; row < end && good; ++row) {
            const size_t at = first + row * place.length;
            dst.ends[first_face + row] = uint32_t(at + place.length);
            for (size_t i = 0; i < place.length; ++i) {
                const double vertex = rows.number(row, place, i).value;
                if (!is_vertex_index(vertex, vertex_count))
                    good = false;
                else
                    dst.corners[at + i] = uint32_t(vertex);
            }
        }
    });
    if (!good) {
        dst.corners.resize(first);
        dst.ends.resize(first_face);
    }
    return good;
}

} // namespace vmlight::ply
