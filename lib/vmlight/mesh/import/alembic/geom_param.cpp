// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/alembic/geom_param.h>

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/alembic/error.h>

#include <algorithm>
#include <iterator>

namespace vmlight::alembic {
namespace {

const char* const kMainSet = "uv";

// A value for each corner, vertex (two names of one thing for polygons), face, or one for the mesh.
enum class Scope
{
    corner,
    vertex,
    face,
    mesh,
    unknown
};

struct ScopeName
{
    const char* name;
    Scope scope;
};
constexpr ScopeName kScopes[] = { { "fvr", Scope::corner },
                                  { "vtx", Scope::vertex },
                                  { "var", Scope::vertex },
                                  { "uni", Scope::face },
                                  { "con", Scope::mesh } };

size_t count_of(Scope scope, const Faces& faces)
{
    switch (scope) {
    case Scope::corner:
        return faces.corners.size();
    case Scope::vertex:
        return faces.vertices;
    case Scope::face:
        return faces.ends.size();
    case Scope::mesh:
        return 1;
    default:
        return 0;
    }
}

Scope scope_of(const std::string& name, size_t count, const Faces& faces)
{
    const auto* const known = std::find_if(std::begin(kScopes), std::end(kScopes),
                                           [&](const ScopeName& scope) { return name == scope.name; });
    if (known != std::end(kScopes) && count_of(known->scope, faces) == count)
        return known->scope;
    for (const Scope scope : { Scope::corner, Scope::vertex, Scope::face, Scope::mesh })
        if (count_of(scope, faces) == count)
            return scope;
    return Scope::unknown;
}

// What corner number `corner` of face number `face` takes its value by.
size_t element_of(Scope scope, const Faces& faces, size_t face, size_t corner)
{
    switch (scope) {
    case Scope::corner:
        return corner;
    case Scope::vertex:
        return faces.corners[corner];
    case Scope::face:
        return face;
    default:
        return 0;
    }
}

bool is_uv_set(const AbcA::PropertyHeader& header)
{
    const AbcA::MetaData& said = header.getMetaData();
    const AbcA::DataType& type = header.getDataType();
    const bool are_pairs = header.isCompound()
        ? said.get("podName") == "float32_t" && said.get("podExtent") == "2"
        : header.isArray() && type.getPod() == ::Alembic::Util::kFloat32POD && type.getExtent() == 2;
    const std::string scope = said.get("geoScope");
    return are_pairs && said.get("interpretation") == "vector" && said.get("notUV") != "1"
        && (scope == "fvr" || scope == "vtx" || scope == "var");
}

} // namespace

GeomParam read_geom_param(const AbcA::CompoundPropertyReaderPtr& parent, const std::string& name, int extent,
                          const Faces& faces, Moment& moment, bool blended, std::string& fault)
{
    GeomParam param;
    const auto indexed = find_compound(parent, name);
    const auto values = indexed ? find_array(indexed, ".vals") : find_array(parent, name);
    const auto indices = find_array(indexed, ".indices");
    if (!values || !holds_floats(*values, extent) || (indexed && !indices))
        return param;
    const SamplePair pair = samples_at(*values, moment);
    param.numbers = read_array<float>(*values, pair.first, extent);
    if (blended && pair.weight > 0 && faces.is_constant && (!indices || indices->isConstant()))
        param.numbers = blend(std::move(param.numbers), read_array<float>(*values, pair.second, extent), pair.weight);
    const size_t count = param.numbers.size() / size_t(extent);
    std::vector<uint32_t> chosen;
    if (indices)
        chosen = read_array<uint32_t>(*indices, samples_at(*indices, moment).first);
    const size_t elements = indices ? chosen.size() : count;
    const Scope scope = scope_of(values->getMetaData().get("geoScope"), elements, faces);
    if (scope == Scope::unknown) {
        fault = format("\"{}\" has {} values, but there are {} corners, {} vertices and {} faces: it is not read", name,
                       elements, faces.corners.size(), faces.vertices, faces.ends.size());
        return GeomParam();
    }
    size_t corner = 0;
    for (size_t face = 0; face < faces.ends.size(); ++face)
        for (; corner < faces.ends[face]; ++corner) {
            const size_t element = element_of(scope, faces, face, corner);
            param.values.push_back(indices ? chosen[element] : uint32_t(element));
            if (param.values.back() >= count)
                throw Error(format("\"{}\" uses value {}, but there are only {}", name, param.values.back(), count));
        }
    return param;
}

std::vector<UvSet> uv_sets(const AbcA::CompoundPropertyReaderPtr& geom)
{
    std::vector<UvSet> sets;
    if (geom && geom->getPropertyHeader(kMainSet))
        sets.push_back({ geom, kMainSet });
    if (const auto others = find_compound(geom, ".arbGeomParams"))
        for (size_t i = 0; i < others->getNumProperties(); ++i)
            if (is_uv_set(others->getPropertyHeader(i)))
                sets.push_back({ others, others->getPropertyHeader(i).getName() });
    return sets;
}

} // namespace vmlight::alembic
