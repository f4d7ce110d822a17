// SPDX-License-Identifier: Apache-2.0
/// The header of PLY files. Source: G. Turk, "The PLY Polygon File Format", 1994.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace vmlight::ply {

struct Type
{
    const char *name, *other_name;
    size_t bytes;
    char kind; ///< 's'igned, 'u'nsigned, 'f'loating point
};

struct Property
{
    std::string name;
    const Type* type;
    const Type* count = nullptr; ///< of a list
};

struct Element
{
    std::string name;
    size_t count;
    std::vector<Property> properties;
};

struct Header
{
    std::string format; ///< "ascii", "binary_little_endian" or "binary_big_endian"
    std::string error; ///< why the header is invalid, or ""
    std::vector<Element> elements;
    std::vector<std::string> textures; ///< as MeshLab's comments name them
    size_t body = 0; ///< the first byte after the header
};

/// Never fails: see Header::error.
Header read_header(const std::string& bytes);

} // namespace vmlight::ply
