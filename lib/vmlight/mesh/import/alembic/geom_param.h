// SPDX-License-Identifier: Apache-2.0
/// Texture coordinates and normals.
#pragma once

#include <vmlight/mesh/import/alembic/properties.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vmlight::alembic {

/// The polygons of a mesh, in the file's order.
struct Faces
{
    std::vector<uint32_t> ends; ///< for each face, the corner behind its last; its first is the last face's end
    std::vector<uint32_t> corners; ///< vertices
    size_t vertices = 0;
    bool is_constant = true; ///< the same at all times
};

/// Values that corners have.
struct GeomParam
{
    std::vector<float> numbers; ///< `extent` for each value
    std::vector<uint32_t> values; ///< of each corner; empty if there are no values

    bool exists() const { return !values.empty(); }
};

/// Read the parameter `name` of a mesh, indexed or not, with `extent` floats a value. Its scope is what the file says,
/// or what its number of values fits.
///
/// @param blended  interpolate between samples, where faces and indices stay the same
/// @param fault    set to what is wrong if the values are for other faces, which happens where they change over time:
///                 it then has none
/// Throws Error if an index is out of range.
GeomParam read_geom_param(const AbcA::CompoundPropertyReaderPtr& parent, const std::string& name, int extent,
                          const Faces& faces, Moment& moment, bool blended, std::string& fault);

/// Where a UV set is.
struct UvSet
{
    AbcA::CompoundPropertyReaderPtr parent;
    std::string name;
};

/// The UV sets of a mesh: "uv", then those among ".arbGeomParams", as AbcGeom::isUV() knows them.
/// @param geom     the properties of the mesh's schema
std::vector<UvSet> uv_sets(const AbcA::CompoundPropertyReaderPtr& geom);

} // namespace vmlight::alembic
