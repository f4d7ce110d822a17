// SPDX-License-Identifier: Apache-2.0
/// The header of PLY files. Source: G. Turk, "The PLY Polygon File Format", 1994.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
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

    /// Triangles are made of it. assimp 5.2 reads some others as vertices, and loses its place after some.
    bool is_mesh() const { return name == "vertex" || name == "face" || name == "tristrips"; }
};

/// Ranges of a file's bytes, in its order.
class ByteRanges
{
public:
    void add(size_t begin, size_t end);
    /// The bytes in the ranges; "" if they are one range from the start of `bytes`.
    std::string text(const std::string& bytes) const;

private:
    std::vector<std::pair<size_t, size_t>> m_ranges;
};

struct Header
{
    std::string format; ///< "ascii", "binary_little_endian" or "binary_big_endian"
    std::string error; ///< why the header is invalid, or ""
    std::vector<Element> elements;
    ByteRanges mesh; ///< its lines less those of elements that are not is_mesh()
    size_t body = 0; ///< the first byte after the header
};

/// Never fails: see Header::error.
Header read_header(const std::string& bytes);

} // namespace vmlight::ply
