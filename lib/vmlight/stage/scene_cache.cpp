// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/scene_cache.h>

#include <vmlight/base/format.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/base/text_format.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/mesh/instances.h>
#include <vmlight/stage/bake_switches.h>
#include <vmlight/stage/unwrap_report.h>
#include <vmlight/stage/uv_sets.h>
#include <vmlight/uv/unwrap.h>

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <mutex>

namespace vmlight {
namespace {

/// Holds one scene while it is built and used.
struct Slot
{
    std::mutex mutex; // held while it is built
    std::weak_ptr<const BakeScene> scene;
};

/// Slots by key. The next call removes slots whose scene is gone.
class Slots
{
public:
    std::shared_ptr<Slot> find(const std::string& key)
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        for (auto at = m_slots.begin(); at != m_slots.end();)
            at = is_left(*at->second, at->second.use_count()) ? m_slots.erase(at) : std::next(at);
        std::shared_ptr<Slot>& slot = m_slots[key];
        if (!slot)
            slot = std::make_shared<Slot>();
        return slot;
    }

private:
    // With no other holder nobody builds in this slot or can start to, so its lock is free.
    static bool is_left(Slot& slot, long holders)
    {
        if (holders > 1)
            return false;
        const std::lock_guard<std::mutex> lock(slot.mutex);
        return slot.scene.expired();
    }
    std::mutex m_mutex;
    std::map<std::string, std::shared_ptr<Slot>> m_slots;
};

// Never destroyed: host threads may still read while the process exits.
Slots& slots()
{
    static auto& all = *new Slots;
    return all;
}

// A part with its scale this many times that of the whole gets a scene of its own.
constexpr double kSmallPart = 64;

bool unwrap(BakeScene& dst, Mesh& mesh, const VismapRecipe& recipe, int nthreads, std::string& error)
{
    const UnwrapParams params = unwrap_params(recipe, nthreads);
    UnwrapReport report;
    if (!unwrap_mesh(mesh, params, &report, error))
        return false;
    dst.remarks.push_back(unwrap_line(report, params));
    if (const std::string warning = unwrap_warning(report); !warning.empty())
        mesh.warnings.push_back(warning);
    return true;
}

bool build_whole(BakeScenePointer& dst, const VismapRecipe& recipe, const SceneStamps& stamps, int nthreads,
                 const StepListener& at_step, double& seconds, std::string& at, std::string& error)
{
    auto mesh = std::make_shared<Mesh>();
    std::vector<Mesh> occluders(recipe.occluder.size());
    auto scene = std::make_shared<BakeScene>();
    for (size_t i = 0; i < stamps.files.size(); ++i)
        if (!read_scene_file(i ? occluders[i - 1] : *mesh, scene->files, recipe, stamps, i, at_step, at, error))
            return false;
    if (mesh->instances) { // they cast, as an occluder does
        Mesh& rest = occluders.emplace_back();
        rest.name = mesh->name;
        rest.path = mesh->path;
        rest.instances = std::move(mesh->instances);
    }
    at = recipe.unwrap ? "unwrap" : "mesh";
    if (recipe.unwrap)
        begin_step(at_step, "unwrap");
    if (recipe.unwrap && !unwrap(*scene, *mesh, recipe, nthreads, error))
        return false;
    at = "mesh";
    if (mesh->uvs.empty()) {
        error = no_uvs_error(recipe);
        return false;
    }
    const Stopwatch timer;
    if (!scene->build(std::move(mesh), occluders, nthreads, error, scene_choice(recipe), at_step))
        return false;
    ++work_counts().scenes_built;
    seconds = timer();
    if (const InstanceCounts& counts = scene->occluder().instances(); scene->occluder().has_instances())
        scene->remarks.push_back(
            counts.instances == 0
                ? format("instances: none kept; {}",
                         count_text(counts.copies, "copy is triangles", "copies are triangles"))
                : format("instances: {} of {}, {:.4g} triangles; {}", counts.instances,
                         count_text(counts.distinct, "mesh", "meshes"), double(counts.triangles),
                         count_text(counts.copies, "further copy is triangles", "further copies are triangles")));
    dst = std::move(scene);
    return true;
}

// The rest of the mesh goes before the occluders. The others are read again: `whole` has not kept them.
bool build_small_part(BakeScene& dst, const BakeScene& whole, std::shared_ptr<const Mesh> part, Mesh rest,
                      const VismapRecipe& recipe, const SceneStamps& stamps, int nthreads, const StepListener& at_step,
                      std::string& at, std::string& error)
{
    std::vector<Mesh> occluders(1 + recipe.occluder.size());
    std::vector<FileStamp> again;
    occluders[0] = std::move(rest);
    for (size_t i = 1; i < stamps.files.size(); ++i)
        if (!read_scene_file(occluders[i], again, recipe, stamps, i, at_step, at, error))
            return false;
    if (whole.reach().size() > recipe.occluder.size()) { // what a scene list does not bake
        Mesh again_whole;
        if (!read_scene_file(again_whole, again, recipe, stamps, 0, at_step, at, error))
            return false;
        occluders.emplace_back().instances = std::move(again_whole.instances);
        occluders.back().name = again_whole.name;
        occluders.back().path = again_whole.path;
    }
    at = "mesh";
    dst.files = whole.files;
    ++work_counts().scenes_built;
    SceneChoice choice = scene_choice(recipe);
    choice.own_parts = 1;
    if (!dst.build(std::move(part), occluders, nthreads, error, choice, at_step))
        return false;
    dst.set_lowest(whole.lowest());
    return true;
}

bool build_part(BakeScenePointer& dst, const BakeScenePointer& whole, const VismapRecipe& recipe,
                const SceneStamps& stamps, int nthreads, const StepListener& at_step, double& seconds, std::string& at,
                std::string& error)
{
    const Stopwatch timer;
    std::vector<bool> chosen;
    if (!choose_triangles(chosen, whole->mesh(), recipe.selection, at, error))
        return false;
    if (std::find(chosen.begin(), chosen.end(), false) == chosen.end()) {
        dst = whole;
        return true;
    }
    auto part = std::make_shared<Mesh>(mesh_part(whole->mesh(), chosen));
    at = "mesh";
    if (part->uvs.empty()) {
        error = no_uvs_error(recipe);
        return false;
    }
    chosen.flip();
    Mesh rest = mesh_part(whole->mesh(), chosen);
    auto scene = std::make_shared<BakeScene>();
    scene->remarks = whole->remarks;
    const bool is_small = SceneFrame::around(*part).scale >= kSmallPart * whole->frame().scale;
    if (is_small) {
        part->warnings = whole->mesh().warnings;
        if (!build_small_part(*scene, *whole, std::move(part), std::move(rest), recipe, stamps, nthreads, at_step, at,
                              error))
            return false;
    } else if (!scene->build_part(whole, std::move(part), rest, error)) {
        return false;
    }
    seconds += timer();
    dst = std::move(scene);
    return true;
}

using Build = std::function<bool(BakeScenePointer& dst)>;

// The scene of this key, from whoever holds it or else from `build`.
bool share(BakeScenePointer& dst, const std::string& key, const Build& build)
{
    const std::shared_ptr<Slot> slot = slots().find(key);
    const std::lock_guard<std::mutex> lock(slot->mutex);
    dst = slot->scene.lock();
    if (dst && !are_unchanged(dst->files)) // e.g. a buffer file that a glTF names
        dst = nullptr;
    if (!dst && !build(dst))
        return false;
    slot->scene = dst;
    return true;
}

std::string selection_key(MeshSelection selection)
{
    std::string key;
    selection.visit([&](const char* name, auto& value, const auto& allowed, const char*) {
        key += std::string(name) + "=" + value_text(value, allowed) + "\n";
    });
    return key;
}

} // namespace

bool share_scene(BakeScenePointer& dst, const VismapRecipe& recipe, const SceneStamps& stamps, int nthreads,
                 double* built, std::string& at, std::string& error, const StepListener& at_step)
{
    double seconds = 0;
    const Build whole = [&](BakeScenePointer& scene) {
        return build_whole(scene, recipe, stamps, nthreads, at_step, seconds, at, error);
    };
    const Build part = [&](BakeScenePointer& scene) {
        BakeScenePointer all;
        return share(all, stamps.key, whole)
            && build_part(scene, all, recipe, stamps, nthreads, at_step, seconds, at, error);
    };
    if (!(recipe.selection.is_all() ? share(dst, stamps.key, whole)
                                    : share(dst, stamps.key + selection_key(recipe.selection), part)))
        return false;
    if (built)
        *built = seconds;
    return true;
}

} // namespace vmlight
