// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/posed_parts.h>

#include <vmlight/base/format.h>

#include <map>
#include <set>

namespace vmlight {
namespace {

// What a scene traces of each mesh, by the mesh's number.
using PartsOfMesh = std::map<int, std::vector<TracedTriangles>>;

PartsOfMesh parts_of(const BakeScene& scene)
{
    PartsOfMesh parts;
    for (const int number : scene.casters())
        parts[number]; // a mesh without triangles is one too
    for (const TracedTriangles& part : scene.occluder().triangles())
        parts[scene.casters()[part.mesh]].push_back(part);
    return parts;
}

size_t place_of(const BakeScene& scene, int number)
{
    return size_t(std::find(scene.casters().begin(), scene.casters().end(), number) - scene.casters().begin());
}

// How the choice of what is traced differs, but for what no ray can meet, or "".
std::string choice_fault(const BakeScene& base, const BakeScene& pose)
{
    const SceneChoice &before = base.choice(), &after = pose.choice();
    if (base.occluder().has_instances() || pose.occluder().has_instances())
        return "instances are not compared";
    if (base.reach().size() != pose.reach().size())
        return format("{} occluders are given, and {} in the other pose", pose.reach().size(), base.reach().size());
    if (base.occluder().has_strands() || pose.occluder().has_strands())
        return "strands among the occluders are not compared";
    return before.self == after.self && before.occluders == after.occluders && before.own_parts == after.own_parts
        ? ""
        : "other meshes occlude";
}

} // namespace

std::vector<PosedPart> match_parts(const BakeScene& base, const BakeScene& pose, std::string& fault)
{
    std::vector<PosedPart> matched;
    fault = choice_fault(base, pose);
    if (!fault.empty())
        return matched;
    const PartsOfMesh before = parts_of(base), after = parts_of(pose);
    std::set<int> numbers(base.casters().begin(), base.casters().end());
    numbers.insert(pose.casters().begin(), pose.casters().end());
    for (const int number : numbers) {
        const auto from = before.find(number), to = after.find(number);
        if (from == before.end() || to == after.end()) {
            for (const TracedTriangles& part : from == before.end() ? to->second : from->second)
                matched.push_back(from == before.end() ? PosedPart { {}, part } : PosedPart { part, {} });
            continue;
        }
        const auto triangles = [](const std::vector<TracedTriangles>& parts) {
            size_t sum = 0;
            for (const TracedTriangles& part : parts)
                sum += part.count;
            return sum;
        };
        const std::string mesh = number == BakeScene::kWhole ? "the mesh" : format("occluder {}", number + 1);
        if (!base.occluder().has_cutouts_of(place_of(base, number), pose.occluder(), place_of(pose, number)))
            fault = format("other parts of {} are cut out", mesh);
        else if (triangles(from->second) != triangles(to->second))
            fault = format("{} has {} triangles that rays can meet, and {} in the other pose", mesh,
                           triangles(to->second), triangles(from->second));
        if (!fault.empty())
            return {};
        for (size_t i = 0; i < from->second.size(); ++i)
            matched.push_back({ from->second[i], to->second[i] });
    }
    return matched;
}

} // namespace vmlight
