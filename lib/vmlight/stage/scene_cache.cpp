// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/scene_cache.h>

#include <vmlight/base/format.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/stage/unwrap_report.h>
#include <vmlight/uv/unwrap.h>

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

const std::string& path_of(const VismapRecipe& recipe, size_t index)
{
    return index ? recipe.occluder[index - 1] : recipe.mesh;
}

const char* key_of(size_t index)
{
    return index ? "occluder" : "mesh";
}

UnwrapParams unwrap_params(const VismapRecipe& recipe, int nthreads)
{
    const Size size = recipe.vismap_params.size();
    return { size.width, size.height, recipe.vismap_params.margin, nthreads };
}

bool unwrap(BakeScene& dst, Mesh& mesh, const VismapRecipe& recipe, int nthreads, std::string& error)
{
    const UnwrapParams params = unwrap_params(recipe, nthreads);
    UnwrapReport report;
    if (!unwrap_mesh(mesh, params, &report, error))
        return false;
    dst.remarks.push_back(unwrap_line(report, params));
    if (const std::string warning = unwrap_warning(report); !warning.empty())
        dst.warnings.push_back(warning);
    return true;
}

bool build(BakeScenePointer& dst, const VismapRecipe& recipe, const SceneStamps& stamps, int nthreads, double& seconds,
           std::string& at, std::string& error)
{
    auto mesh = std::make_shared<Mesh>();
    std::vector<Mesh> occluders(recipe.occluder.size());
    auto scene = std::make_shared<BakeScene>();
    const auto keep_stamp = [&](const std::string& path) {
        FileStamp file { path, "" };
        std::string ignored;
        if (stamp_file(file.stamp, path, ignored))
            scene->files.push_back(std::move(file));
    };
    for (size_t i = 0; i < stamps.files.size(); ++i) {
        at = key_of(i);
        if (!read_mesh(i ? occluders[i - 1] : *mesh, path_of(recipe, i), recipe.mesh_params, error, keep_stamp)
            || !check_stamp(stamps.files[i], path_of(recipe, i), error))
            return false;
    }
    at = recipe.unwrap ? "unwrap" : key_of(0);
    if (recipe.unwrap && !unwrap(*scene, *mesh, recipe, nthreads, error))
        return false;
    work_counts().meshes_read += int64_t(stamps.files.size());
    const Stopwatch timer;
    at = key_of(0);
    if (!scene->build(std::move(mesh), occluders, nthreads, error))
        return false;
    ++work_counts().scenes_built;
    seconds = timer();
    dst = std::move(scene);
    return true;
}

} // namespace

bool stamp_scene(SceneStamps& dst, const VismapRecipe& recipe, std::string& at, std::string& error)
{
    SceneStamps stamps;
    stamps.files.resize(1 + recipe.occluder.size());
    MeshParams params = recipe.mesh_params;
    params.visit([&](const char* name, auto& value, const auto& allowed, const char*) {
        stamps.key += std::string(name) + "=" + value_text(value, allowed) + "\n";
    });
    if (recipe.unwrap) {
        const UnwrapParams atlas = unwrap_params(recipe, 0);
        stamps.key += format("unwrap={}x{},{}\n", atlas.width, atlas.height, atlas.margin);
    }
    for (size_t i = 0; i < stamps.files.size(); ++i) {
        at = key_of(i);
        if (!stamp_file(stamps.files[i], path_of(recipe, i), error))
            return false;
        stamps.key += stamps.files[i];
    }
    dst = std::move(stamps);
    return true;
}

bool share_scene(BakeScenePointer& dst, const VismapRecipe& recipe, const SceneStamps& stamps, int nthreads,
                 double* built, std::string& at, std::string& error)
{
    double seconds = 0;
    const std::shared_ptr<Slot> slot = slots().find(stamps.key);
    const std::lock_guard<std::mutex> lock(slot->mutex);
    dst = slot->scene.lock();
    if (dst && !are_unchanged(dst->files)) // e.g. a buffer file that a glTF names
        dst = nullptr;
    if (!dst && !build(dst, recipe, stamps, nthreads, seconds, at, error))
        return false;
    slot->scene = dst;
    if (built)
        *built = seconds;
    return true;
}

} // namespace vmlight
