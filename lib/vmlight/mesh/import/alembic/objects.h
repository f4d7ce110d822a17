// SPDX-License-Identifier: Apache-2.0
/// The objects of an archive, and which of them are instances of others.
#pragma once

#include <vmlight/mesh/import/alembic/ogawa.h>
#include <vmlight/mesh/import/alembic/properties.h>
#include <vmlight/mesh/import/node_graph.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>

namespace vmlight::alembic {

/// An object, and the position of its group in the file.
struct Object
{
    AbcA::ObjectReaderPtr reader;
    uint64_t group = 0;
};

class Objects
{
public:
    /// Open a file. Throws Error, or what the library throws, if it cannot be read; if an object is in two places, is
    /// its own ancestor or an instance of what does not exist; or if there are more than a million, counting all
    /// instances, or nested more than 10000 deep: a short file may ask for endlessly many.
    explicit Objects(const std::string& path);

    /// It has no meaning but to hold the others.
    const Object& top() const { return m_top; }
    /// Child number `index` of object.reader->getNumChildren().
    Object child(const Object& object, size_t index);
    /// An instance has nothing of its own but its name.
    static bool is_instance(const Object& object);
    /// The object that an instance is an instance of, which may be one too.
    Object source(const Object& instance);

private:
    void add_children(NodeGraph<uint64_t>& graph, const Object& object, int depth);
    std::string source_path(const Object& instance);
    Object find(const std::string& path, int depth);

    OgawaFile m_file;
    AbcA::ArchiveReaderPtr m_archive;
    Object m_top;
    std::unordered_map<uint64_t, std::string> m_names; // of objects, by their groups
    std::map<std::string, Object> m_found;
};

} // namespace vmlight::alembic
