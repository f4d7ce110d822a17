// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/bake_scene.h>

#include <vmlight/base/available_memory.h>
#include <vmlight/base/format.h>
#include <vmlight/mesh/instances.h>
#include <vmlight/mesh/opacity_hash.h>
#include <vmlight/mesh/shape.h>
#include <vmlight/mesh/strands.h>
#include <vmlight/trace/curves.h>
#include <vmlight/trace/horizon.h>
#include <vmlight/trace/instance_boxes.h>
#include <vmlight/trace/surface.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vmlight {
namespace {

// Of fewer, what reading them has left behind does not count.
constexpr size_t kManyTriangles = size_t(1) << 20;

int64_t count_tiny(const Mesh& mesh, const SceneFrame& frame)
{
    int64_t count = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Imath::V3d &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
        const double longest = std::max({ (q - p).length(), (r - q).length(), (p - r).length() });
        count += longest > 0 && longest * frame.scale < kTinyTriangle;
    }
    return count;
}

// How far rounding to float moves the mesh's vertices, relative to its size. 0 if coordinates are more than floats.
double rounding_of(const Mesh& mesh, const SceneFrame& frame)
{
    if (mesh.has_exact_positions)
        return 0;
    double reach = 0;
    for (const auto& triangle : mesh.triangles)
        for (uint32_t vertex : triangle)
            for (int axis = 0; axis < 3; ++axis) {
                const double x = mesh.positions[vertex][axis];
                if (x != double(float(x)))
                    return 0;
                reach = std::max(reach, std::abs(x));
            }
    return reach * frame.scale * std::numeric_limits<float>::epsilon() / 4;
}

// What is wrong with the mesh to bake, or "".
std::string bake_fault(const Mesh& mesh)
{
    const std::string& path = mesh.path.empty() ? mesh.name : mesh.path;
    if (mesh.triangles.empty())
        return format("\"{}\": no triangles", path);
    return mesh.uvs.empty() ? format("\"{}\": no texture coordinates in this UV set: choose another uv_set, or unwrap "
                                     "the mesh with makevismap --unwrap",
                                     path)
                            : "";
}

} // namespace

bool check_reach(const Mesh& mesh, const SceneFrame& frame, std::string& error)
{
    for (const auto& triangle : mesh.triangles)
        for (uint32_t vertex : triangle) {
            const double reach = ((mesh.positions[vertex] - frame.centre) * frame.scale).length();
            if (reach <= kFarthestCaster)
                continue;
            error = format(
                "\"{}\": vertex {} is {:.2g} times the size of the baked mesh away; rays reach at most {:g} times",
                mesh.path.empty() ? mesh.name : mesh.path, vertex, reach, kFarthestCaster);
            return false;
        }
    if (!check_instance_reach(mesh, frame, error))
        return false;
    if (!mesh.strands)
        return true;
    for (size_t p = 0; p < mesh.strands->points.size(); ++p) {
        const double reach = ((mesh.strands->points[p] - frame.centre) * frame.scale).length();
        if (reach <= kFarthestCaster)
            continue;
        error = format("\"{}\": point {} is {:.2g} times the size of what is baked away; rays reach at most {:g} times",
                       mesh.strands->path, p, reach, kFarthestCaster);
        return false;
    }
    return true;
}

void BakeScene::measure()
{
    m_tiny = count_tiny(*m_mesh, m_frame);
    m_rounding = rounding_of(*m_mesh, m_frame);
    m_mesh_hash = vmlight::mesh_hash(*m_mesh);
    m_mesh_shape = vmlight::mesh_shape(*m_mesh);
}

bool BakeScene::build(std::shared_ptr<const Mesh> mesh, const std::vector<Mesh>& occluders, int nthreads,
                      std::string& error, const SceneChoice& choice, const StepListener& at_step)
{
    error = bake_fault(*mesh);
    if (!error.empty())
        return false;
    std::vector<const Mesh*> casters { mesh.get() };
    for (const Mesh& occluder : occluders)
        casters.push_back(&occluder);
    for (const Mesh* caster : casters)
        if (!check_mesh(*caster, error) || !check_instances(*caster, error))
            return false;
    m_frame = SceneFrame::around(*mesh);
    for (const Mesh* caster : casters)
        if (!check_reach(*caster, m_frame, error))
            return false;
    m_mesh = std::move(mesh);
    m_choice = choice;
    if (!trace(occluders, nthreads, error, at_step))
        return false;
    for (const Mesh& caster : occluders) {
        m_occluder_hashes += (m_occluder_hashes.empty() ? "" : ",") + vmlight::mesh_hash(caster);
        m_occluder_names += (m_occluder_names.empty() ? "" : ", ") + (caster.name.empty() ? "unnamed" : caster.name);
    }
    for (const Mesh* caster : casters) {
        m_triangles += held_triangles(*caster);
        m_spans += caster->strands ? int64_t(caster->strands->points.size() - caster->strands->count()) : 0;
        m_opacity_hashes += (caster == casters[0] ? "" : ",") + opacity_hash(*caster);
        for (const std::string& warning : caster->warnings)
            m_warnings.push_back(format("\"{}\": {}", caster->path.empty() ? caster->name : caster->path, warning));
    }
    m_lowest = std::numeric_limits<double>::infinity();
    for (const auto& triangle : m_mesh->triangles)
        for (const uint32_t vertex : triangle)
            m_lowest = std::min(m_lowest, m_mesh->positions[vertex].y);
    measure();
    return true;
}

// Give Embree what the rays of the mesh can meet.
bool BakeScene::trace(const std::vector<Mesh>& occluders, int nthreads, std::string& error, const StepListener& at_step)
{
    std::vector<const Mesh*> casters { m_choice.self ? m_mesh.get() : nullptr };
    if (m_choice.self)
        m_casters.push_back(kWhole);
    SceneBox box = scene_box(*m_mesh, m_frame);
    if (!occluders.empty())
        begin_step(at_step, "find what occluders reach");
    for (const Mesh& occluder : occluders) {
        m_reach.push_back(find_reach(*m_mesh, occluder, m_frame, m_choice));
        box.add(scene_box(occluder, m_frame));
        for (const SceneBox& instance : instance_boxes(occluder, m_frame))
            box.add(instance);
        const bool is_traced = m_reach.back().is_traced(m_choice, m_reach.size() - 1);
        casters.push_back(is_traced ? &occluder : nullptr);
        if (is_traced)
            m_casters.push_back(int(m_reach.size()) - 1);
    }
    m_diagonal = (Imath::V3d(box.high) - Imath::V3d(box.low)).length() / m_frame.scale;
    const auto occluder = std::make_shared<Occluder>();
    m_occluder = occluder;
    size_t triangles = 0;
    for (const Mesh* caster : casters)
        triangles += caster ? caster->triangles.size() : 0;
    if (triangles >= kManyTriangles)
        release_freed_memory(); // of reading: the most is held while Embree builds
    return occluder->build(casters, m_frame, nthreads, error, m_choice.cutouts, at_step, m_choice.instances,
                           m_mesh.get());
}

bool BakeScene::build_part(std::shared_ptr<const BakeScene> whole, std::shared_ptr<const Mesh> part, const Mesh& rest,
                           std::string& error)
{
    error = bake_fault(*part);
    if (!error.empty())
        return false;
    m_frame = whole->m_frame;
    m_occluder = whole->m_occluder;
    m_occluder_hashes
        = vmlight::mesh_hash(rest) + (whole->m_occluder_hashes.empty() ? "" : ",") + whole->m_occluder_hashes;
    m_occluder_names = whole->m_occluder_names;
    m_opacity_hashes = whole->m_opacity_hashes;
    m_triangles = whole->m_triangles;
    m_spans = whole->m_spans;
    m_lowest = whole->m_lowest;
    m_diagonal = whole->m_diagonal;
    m_choice = whole->m_choice;
    m_reach = whole->m_reach;
    m_warnings = whole->m_warnings;
    files = whole->files;
    m_mesh = std::move(part);
    m_whole = std::move(whole);
    measure();
    return true;
}

const CasterReach* BakeScene::culled_occluder() const
{
    SceneChoice whole = m_choice;
    whole.cull = false;
    for (size_t i = 0; i < m_reach.size(); ++i)
        if (m_reach[i].is_traced(whole, i) && !m_reach[i].is_traced(m_choice, i))
            return &m_reach[i];
    return nullptr;
}

size_t BakeScene::bytes() const
{
    // Embree needs about 80 bytes per triangle, of which the mesh has 12, and with what is kept here of its place 700
    // per instance.
    return (m_whole ? m_whole->bytes()
                    : 80 * size_t(m_triangles) - 12 * m_mesh->triangles.size() + size_t(kBytesOfSpan) * size_t(m_spans)
                    + 700 * size_t(m_occluder->instances().instances) + m_occluder->cutouts().bytes)
        + 12 * m_mesh->triangles.size() + m_mesh->triangle_materials.bytes() + m_mesh->triangle_nodes.bytes()
        + 48 * m_mesh->positions.size();
}

} // namespace vmlight
