// SPDX-License-Identifier: Apache-2.0
/// Rows of a binary PLY element whose numbers all lie at the same places.
#pragma once

#include <vmlight/mesh/import/ply_body.h>
#include <vmlight/mesh/import/ply_file.h>
#include <vmlight/mesh/import/ply_roles.h>

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace vmlight::ply {

/// As of all vertices, and of faces that all have as many corners: can be read in parallel.
class EvenRows
{
public:
    struct Place
    {
        const Type* type;
        size_t offset; ///< of the first number, in a row
        size_t length; ///< of the list; 1 of a property that is none
    };

    /// Nothing if the file is ascii, if it ends inside the element, or if a list is not as long as in the first row.
    static std::optional<EvenRows> find(const Element& element, const Body& body);

    size_t count() const { return m_count; }
    size_t bytes() const { return m_count * m_stride; }
    /// Of each property.
    const std::vector<Place>& places() const { return m_places; }
    /// Number `i` of a property.
    TextNumber number(size_t row, const Place& place, size_t i = 0) const
    {
        return m_body->number_at(*place.type, row * m_stride + place.offset + i * place.type->bytes);
    }

private:
    bool have_equal_lists(const Element& element) const;

    const Body* m_body = nullptr;
    size_t m_count = 0, m_stride = 0;
    std::vector<Place> m_places;
};

/// Set the vertices of `dst` to those of the rows.
void read_vertices(File& dst, const EvenRows& rows, const Roles& roles, const VertexParts& parts);

/// Add the faces of the rows to `dst`.
/// @returns false, with nothing added, if they have no corners, or one that is not a vertex
bool read_faces(File& dst, const EvenRows& rows, const Roles& roles, size_t vertex_count);

inline bool is_vertex_index(double number, size_t vertex_count)
{
    return number >= 0 && number < double(vertex_count) && number == std::floor(number);
}

} // namespace vmlight::ply
