// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/alembic/hierarchy.h>

#include <vmlight/mesh/import/alembic/poly_mesh.h>
#include <vmlight/mesh/import/alembic/transform.h>

#include <optional>

namespace vmlight::alembic {
namespace {

std::optional<double> seconds_of(const MeshParams& params)
{
    if (params.frame == MeshParams::kFirstSample)
        return std::nullopt;
    return params.frame / params.fps;
}

} // namespace

Hierarchy::Hierarchy(const std::string& path, const MeshParams& params, const Imath::M44d& root)
    : m_objects(path)
    , m_moment(seconds_of(params))
    , m_root(root)
{
}

void Hierarchy::visit(const Enter& enter, const Show& show)
{
    Place place;
    place.to_object = m_root;
    visit_children(m_objects.top(), place, enter, show);
}

bool Hierarchy::visit_children(const Object& object, const Place& place, const Enter& enter, const Show& show)
{
    for (size_t i = 0; i < object.reader->getNumChildren(); ++i)
        if (!is_face_set(object.reader->getChildHeader(i))
            && !visit_object(m_objects.child(object, i), object.reader->getChildHeader(i).getName(), place, enter,
                             show))
            return false;
    return true;
}

bool Hierarchy::visit_object(const Object& object, const std::string& name, const Place& place, const Enter& enter,
                             const Show& show)
{
    if (Objects::is_instance(object))
        return visit_object(m_objects.source(object), name, place, enter, show);
    const auto properties = object.reader->getProperties();
    const Transform transform = read_transform(properties, m_moment);
    Place here;
    here.node = enter(name, place.node);
    here.named_node = place.children == 1 ? place.node : here.node;
    here.children = transform.exists ? object.reader->getNumChildren() : 0;
    here.to_object = transform.matrix * (transform.inherits ? place.to_object : m_root);
    here.is_visible = is_visible(properties, place.is_visible);
    return show(object, name, here) && visit_children(object, here, enter, show);
}

bool Hierarchy::is_visible(const AbcA::CompoundPropertyReaderPtr& properties, bool is_parent_visible)
{
    constexpr int8_t kAsParent = -1;
    const auto visible = find_scalar(properties, "visible");
    if (!visible)
        return is_parent_visible;
    const std::vector<int8_t> said = read_scalar<int8_t>(*visible, samples_at(*visible, m_moment).first);
    return said.empty() || said[0] == kAsParent ? is_parent_visible : said[0] != 0;
}

} // namespace vmlight::alembic
