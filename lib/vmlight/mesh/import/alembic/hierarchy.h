// SPDX-License-Identifier: Apache-2.0
/// What an archive shows, and where.
#pragma once

#include <vmlight/mesh/import/alembic/objects.h>
#include <vmlight/mesh/mesh.h>

#include <Imath/ImathMatrix.h>

#include <cstddef>
#include <functional>
#include <string>

namespace vmlight::alembic {

/// Where an object appears.
struct Place
{
    int node = -1; ///< what `enter` returned for it
    /// The one that users know it by: that of the transform above, if this is the only object there, as programs write
    /// meshes; else its own.
    int named_node = -1;
    size_t children = 0; ///< of a transform
    Imath::M44d to_object; ///< from its own space
    bool is_visible = true;
};

/// The objects of a file at one moment, each as often as it is shown: an instance is another object under its own name.
class Hierarchy
{
public:
    /// @param root     what turns the file's axes
    /// Throws as Objects.
    Hierarchy(const std::string& path, const MeshParams& params, const Imath::M44d& root);

    /// @param enter    called for each object before `show`: its name, and what it returned for the object above, or -1
    /// @param show     returns false to see no more
    using Enter = std::function<int(const std::string& name, int parent)>;
    using Show = std::function<bool(const Object& object, const std::string& name, const Place& place)>;
    /// Visit all objects but face sets, parents first. Recurses as deep as the hierarchy. Throws Error, or what the
    /// library throws, where a transform cannot be read.
    void visit(const Enter& enter, const Show& show);

    /// Of MeshParams::frame; knows the times of what was read by it.
    Moment& moment() { return m_moment; }

private:
    bool visit_children(const Object& object, const Place& place, const Enter& enter, const Show& show);
    bool visit_object(const Object& object, const std::string& name, const Place& place, const Enter& enter,
                      const Show& show);
    bool is_visible(const AbcA::CompoundPropertyReaderPtr& properties, bool is_parent_visible);

    Objects m_objects;
    Moment m_moment;
    const Imath::M44d m_root;
};

} // namespace vmlight::alembic
