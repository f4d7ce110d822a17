// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/available_memory.h>
#include <vmlight/base/format.h>
#include <vmlight/trace/embree_scene.h>
#include <vmlight/trace/exact_hit.h>

#include <algorithm>

namespace vmlight::embree {
namespace {

// Of a triangle that is built on its own, at most; and of one that may be cut out.
constexpr double kBytesOfCopy = 150, kBytesOfCutout = 365;

// Of a distinct mesh, or nullptr.
const Cutouts* cutouts_of(const PlacedMeshes& placed, size_t mesh)
{
    return mesh < placed.cutouts.size() ? placed.cutouts[mesh] : nullptr;
}

uint64_t bits_of(size_t place)
{
    return uint64_t(place + 1) * 0x9e3779b97f4a7c15u;
}

} // namespace

// Copies first: the numbers of instances follow each other.
bool Scene::attach_placed(const std::vector<PlacedMeshes>& placed, unsigned next_id, std::string& error)
{
    struct Found
    {
        size_t distinct; // in m_distinct
        Placements::Placement placement;
    };
    std::vector<Found> found;
    double copied = 0;
    for (const PlacedMeshes& group : placed) {
        const MeshInstances& all = *group.instances;
        const size_t first = m_distinct.size();
        for (const Mesh& mesh : all.meshes) {
            m_distinct.push_back(std::make_unique<Part>());
            m_distinct.back()->frame = SceneFrame::around(mesh);
        }
        const bool are_instances
            = group.mode == InstanceMode::all || (group.mode == InstanceMode::many && are_many(all));
        for (size_t i = 0; i < all.places.size(); ++i) {
            const MeshInstances::Place& place = all.places[i];
            const Mesh& mesh = all.meshes[place.mesh];
            if (mesh.triangles.empty())
                continue;
            const size_t distinct = first + place.mesh;
            InstanceTransform transform;
            if (are_instances
                && instance_transform(transform, place.to_object, m_distinct[distinct]->frame, m_whole.frame)) {
                found.push_back({ distinct, { transform, bits_of(i), uint32_t(group.mesh) } });
                m_counts.triangles += int64_t(mesh.triangles.size());
                continue;
            }
            copied += (cutouts_of(group, place.mesh) ? kBytesOfCutout : kBytesOfCopy) * double(mesh.triangles.size());
            if (copied > 1e9 && copied > double(available_memory())) {
                error = format("out of memory: instances that must be triangles of their own, since they are larger "
                               "than what is baked or scaled unevenly, need more than {:.3g} GB",
                               copied * 1e-9);
                return false;
            }
            if (!attach_copy(group, i, next_id))
                return false;
            ++m_counts.copies;
        }
    }
    size_t first = 0;
    for (const PlacedMeshes& group : placed) {
        for (size_t mesh = 0; mesh < group.instances->meshes.size(); ++mesh) {
            Part& part = *m_distinct[first + mesh];
            if (std::none_of(found.begin(), found.end(),
                             [&](const Found& instance) { return instance.distinct == first + mesh; }))
                continue;
            const Mesh& triangles = group.instances->meshes[mesh];
            start(part, false);
            const Cutouts* const cutouts = cutouts_of(group, mesh);
            if (!(cutouts ? attach_sorted(part, triangles, *cutouts, 0, 1) : attach(part, triangles, 0)))
                return false;
            rtcCommitScene(part.scene);
            ++m_counts.distinct;
        }
        first += group.instances->meshes.size();
    }
    for (const Found& instance : found) {
        attach_instance(*m_distinct[instance.distinct], instance.placement.transform, next_id);
        m_placements->add(next_id++, instance.placement);
    }
    m_counts.instances = int64_t(found.size());
    return true;
}

bool Scene::attach_copy(const PlacedMeshes& placed, size_t place, unsigned& next_id)
{
    const MeshInstances& all = *placed.instances;
    const uint32_t number = all.places[place].mesh;
    Mesh copy = placed_mesh(all.meshes[number], all.places[place].to_object);
    copy.triangles = all.meshes[number].triangles; // with the corners that its cut-outs know, also in a mirror
    const bool is_mirrored = all.places[place].to_object.determinant() < 0;
    const size_t first = m_whole.buffers.size();
    const Cutouts* const cutouts = cutouts_of(placed, number);
    const bool good
        = cutouts ? attach_sorted(m_whole, copy, *cutouts, next_id, next_id + 1) : attach(m_whole, copy, next_id);
    next_id += cutouts ? 2 : 1;
    for (size_t i = first; i < m_whole.buffers.size(); ++i) {
        m_whole.buffers[i].mesh = placed.mesh;
        m_whole.buffers[i].bits = bits_of(place);
        m_whole.buffers[i].is_mirrored = is_mirrored;
    }
    return good;
}

void Scene::attach_instance(const Part& distinct, const InstanceTransform& transform, unsigned id)
{
    RTCGeometry geometry = rtcNewGeometry(m_device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, distinct.scene);
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, transform.columns.data());
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(m_whole.scene, geometry, id);
    rtcReleaseGeometry(geometry);
}

} // namespace vmlight::embree
