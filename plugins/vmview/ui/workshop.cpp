// SPDX-License-Identifier: Apache-2.0
#include "workshop.h"

#include <vmlight/base/format.h>
#include <vmlight/base/parallel.h>

#include <OpenImageIO/filesystem.h>

#include <algorithm>
#include <utility>

namespace vmlight::view {
namespace {

template <class T> bool take_from(Job<T>& job, T& dst, std::string& problem)
{
    auto result = job.take();
    if (!result)
        return false;
    if (!result->error.empty()) {
        if (result->error != "interrupted")
            problem = result->error;
        return false;
    }
    dst = std::move(result->value);
    return true;
}

template <class T> JobResult<T> last_result(T value, std::string error)
{
    return { std::move(value), std::move(error), true };
}

// Stops with the job.
MakeOptions options_for(int threads, const Progress& go_on)
{
    MakeOptions options;
    options.threads = threads;
    options.progress = [go_on](const std::string&, int64_t) { return go_on; };
    return options;
}

MakeOptions reading_options(const Progress& go_on, const std::shared_ptr<Warnings>& warnings)
{
    MakeOptions options = options_for(0, go_on);
    options.warn = [warnings](const std::string& line) { warnings->add(line); };
    return options;
}

// Maps of 1, 4, 16, ... rays per texel, up to `most`, until one fails.
template <class Bake>
void post_finer(const Job<MapPointer>::Post& post, int most, const Bake& bake, const std::string& error)
{
    for (int samples = 1;; samples = std::min(4 * samples, most)) {
        MapPointer map = bake(samples);
        const bool is_last = !map || samples >= most;
        post({ std::move(map), error, is_last });
        if (is_last)
            return;
    }
}

} // namespace

Workshop::Workshop(Request request, std::function<void()> wake)
    : m_request(std::move(request))
    , m_threads(std::max(1, worker_count(0) - 1))
    , m_mesh_job(wake)
    , m_map_job(wake)
    , m_light_job(wake)
{
    m_request.filter.suns = m_request.trace.suns == "off" ? "off" : "auto";
    if (!m_request.environment.empty())
        read_light(m_request.environment);
    if (!m_request.mesh.mesh.empty())
        read_mesh(m_request.mesh.mesh);
}

bool Workshop::open(const std::string& path, std::string& error)
{
    switch (kind_of_file(path, error)) {
    case AssetKind::none:
        return false;
    case AssetKind::mesh:
        if (!m_request.mesh.mesh.empty()) { // the map, and what is beside it, are of another mesh
            m_request.vismap.clear();
            m_request.view.object.clear();
        }
        read_mesh(path);
        return true;
    case AssetKind::light:
        read_light(path);
        return true;
    case AssetKind::map:
        m_request.vismap = path;
        if (m_mesh && m_mesh->is_unwrapped && !m_request.mesh.unwrap)
            read_mesh(m_request.mesh.mesh); // with the UVs of the file, which the map has
        else if (m_mesh)
            read_map(path);
        return true;
    }
    return false;
}

void Workshop::read_mesh(const std::string& path)
{
    m_map_job.stop();
    m_mesh.reset();
    m_request.mesh.mesh = path;
    const std::string space = m_light ? m_light->light.space : "";
    m_mesh_job.start([asked = mesh_request(m_request), has_map = !m_request.vismap.empty(), space,
                      config = m_request.filter.colorconfig,
                      warnings = m_warnings](const auto& post, const auto& go_on) {
        std::string error;
        MeshPointer mesh = read_mesh_asset(asked, has_map, space, config, reading_options(go_on, warnings), error);
        post(last_result(std::move(mesh), error));
    });
}

void Workshop::read_light(const std::string& path)
{
    m_request.environment = path;
    m_light_job.start([path, filter = m_request.filter, blur = m_request.view.background_blur,
                       specular = m_request.specular, warnings = m_warnings](const auto& post, const auto& go_on) {
        std::string error;
        LightPointer light = read_light_asset(path, filter, blur, specular, reading_options(go_on, warnings), error);
        post(last_result(std::move(light), error));
    });
}

void Workshop::read_map(const std::string& path)
{
    m_basis.clear();
    m_map_activity = format("read: {}", OIIO::Filesystem::filename(path));
    m_map_job.start([mesh = m_mesh, path, most = m_request.mesh.vismap_params.samples, threads = m_threads,
                     warnings = m_warnings](const auto& post, const auto& go_on) {
        std::string error;
        const MapPointer map = read_map_asset(path, *mesh, reading_options(go_on, warnings), error);
        if (!map || mesh->beside.empty()) {
            post(last_result(map, error));
            return;
        }
        post_finer(
            post, most,
            [&](int samples) {
                return with_maps_beside(map, *mesh, "auto", samples, options_for(threads, go_on), error);
            },
            error);
    });
}

void Workshop::bake_for(const std::string& model)
{
    if (!m_mesh || !m_request.vismap.empty())
        return;
    const VismapParams& asked = m_mesh->recipe.vismap_params;
    const VismapParams params = m_mesh->is_strands() ? strand_bake_params(asked, model) : bake_params(asked, model);
    const bool needs_none = params.basis == "vector" && !m_basis.empty();
    if (params.basis == m_basis || needs_none)
        return;
    m_basis = params.basis;
    m_map_activity = "bake";
    m_map_job.start([mesh = m_mesh, model, most = params.samples, threads = m_threads](const auto& post,
                                                                                       const auto& go_on) {
        std::string error;
        post_finer(
            post, most,
            [&](int samples) { return bake_map(*mesh, model, samples, options_for(threads, go_on), error); }, error);
    });
}

void Workshop::split_suns(bool splits)
{
    const char* word = splits ? "auto" : "off";
    if (m_request.filter.suns == word)
        return;
    m_request.filter.suns = word;
    if (!m_request.environment.empty())
        read_light(m_request.environment);
}

bool Workshop::take_mesh(MeshPointer& dst, std::string& problem)
{
    if (!take_from(m_mesh_job, m_mesh, problem))
        return false;
    dst = m_mesh;
    m_basis.clear();
    if (!m_request.vismap.empty())
        read_map(m_request.vismap);
    return true;
}

bool Workshop::take_map(MapPointer& dst, std::string& problem)
{
    return take_from(m_map_job, dst, problem);
}

bool Workshop::take_light(LightPointer& dst, std::string& problem)
{
    if (!take_from(m_light_job, m_light, problem))
        return false;
    dst = m_light;
    return true;
}

std::string Workshop::activity() const
{
    return m_mesh_job.is_busy() ? "read: mesh"
        : m_light_job.is_busy() ? "filter: environment"
        : m_map_job.is_busy()   ? m_map_activity
                                : "";
}

double Workshop::done() const
{
    return m_mesh_job.is_busy() ? m_mesh_job.done() : m_light_job.is_busy() ? m_light_job.done() : m_map_job.done();
}

void Workshop::stop()
{
    m_mesh_job.stop();
    m_map_job.stop();
    m_light_job.stop();
}

} // namespace vmlight::view
