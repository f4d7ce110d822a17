// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/alembic/objects.h>

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/alembic/error.h>

#include <Alembic/AbcCoreOgawa/All.h>

#include <OpenImageIO/strutil.h>

namespace vmlight::alembic {
namespace {

constexpr size_t kMostNodes = 1000000; // with all instances
constexpr int kMostDeep = 10000; // the deep stack holds several times as many

} // namespace

Objects::Objects(const std::string& path)
    : m_file(path)
    , m_archive(::Alembic::AbcCoreOgawa::ReadArchive(1, false)(path))
{
    m_top = { m_archive->getTop(), m_file.top_object() };
    NodeGraph<uint64_t> graph({ kMostNodes, kMostDeep });
    add_children(graph, m_top, 0);
    const std::string error
        = graph.error(m_top.group, [&](uint64_t group) { return format("\"{}\"", m_names[group]); });
    if (!error.empty())
        throw Error(error);
}

Object Objects::child(const Object& object, size_t index)
{
    return { object.reader->getChild(index), m_file.element(object.group, index + 1) };
}

bool Objects::is_instance(const Object& object)
{
    return object.reader->getMetaData().get("isInstance") == "1";
}

Object Objects::source(const Object& instance)
{
    const std::string path = source_path(instance);
    Object source = find(path, 0);
    if (!source.reader)
        throw Error(
            format("\"{}\" is an instance of \"{}\", which does not exist", instance.reader->getFullName(), path));
    return source;
}

// Recurses as deep as the hierarchy.
void Objects::add_children(NodeGraph<uint64_t>& graph, const Object& object, int depth)
{
    if (depth > kMostDeep)
        throw Error(format("objects are nested more than {} deep", kMostDeep));
    const bool is_new = m_names.emplace(object.group, object.reader->getFullName()).second;
    if (!is_new && object.group != 0) // at 0 is one without anything
        throw Error(format("damaged: object \"{}\" is in two places", object.reader->getFullName()));
    if (is_instance(object))
        graph.add(object.group, source(object).group);
    for (size_t i = 0; i < object.reader->getNumChildren(); ++i) {
        const Object below = child(object, i);
        graph.add(object.group, below.group);
        add_children(graph, below, depth + 1);
    }
}

std::string Objects::source_path(const Object& instance)
{
    const auto properties = instance.reader->getProperties();
    for (size_t i = 0; i < properties->getNumProperties(); ++i)
        if (properties->getPropertyHeader(i).getName() == ".instanceSource")
            return m_file.text(m_file.element(m_file.element(instance.group, 0), i));
    return "";
}

// The object of a path such as "/a/b"; a step into an instance leads into its source. Without a reader if there is
// none.
Object Objects::find(const std::string& path, int depth)
{
    if (const auto known = m_found.find(path); known != m_found.end())
        return known->second;
    constexpr int kMostSteps = 100;
    if (depth > kMostSteps)
        throw Error(format("\"{}\" is an instance of an instance, and so on", path));
    Object object = m_top;
    for (const std::string& name : OIIO::Strutil::splits(path, "/")) {
        if (name.empty())
            continue;
        if (is_instance(object))
            object = find(source_path(object), depth + 1);
        if (!object.reader)
            return {};
        size_t i = 0;
        while (i < object.reader->getNumChildren() && object.reader->getChildHeader(i).getName() != name)
            ++i;
        if (i == object.reader->getNumChildren())
            return {};
        object = child(object, i);
    }
    return m_found[path] = object.reader == m_top.reader ? Object() : object;
}

} // namespace vmlight::alembic
