// SPDX-License-Identifier: Apache-2.0
/// What is read and baked in the background while the window stays live.
#pragma once

#include "../scene/job.h"
#include "../scene/loading.h"
#include "../scene/warnings.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace vmlight::view {

class Workshop
{
public:
    /// @param wake     called from other threads when there is something to take
    Workshop(Request request, std::function<void()> wake);

    /// Read a file of the kind that its name or contents say; a map that comes before a mesh waits for it. False, with
    /// the reason in `error`, if it cannot be looked at.
    bool open(const std::string& path, std::string& error);
    /// Bake the mesh's map for `model`, whole maps of 1, 4, 16, ... rays per texel, up to those that were asked for;
    /// nothing if the map that is there, or being baked, serves.
    void bake_for(const std::string& model);

    /// Split the suns off the environment, or leave them in it: filters it again if that is not how it is.
    void split_suns(bool splits);

    /// Take what is ready. Each is true once for each result; `problem` is set if something failed.
    bool take_mesh(MeshPointer& dst, std::string& problem);
    bool take_map(MapPointer& dst, std::string& problem);
    bool take_light(LightPointer& dst, std::string& problem);

    /// What was warned of since the last call.
    std::vector<std::string> take_warnings() { return m_warnings->take(); }

    /// What goes on, or "".
    std::string activity() const;
    /// The share of it that is done.
    double done() const;
    /// Whether the best map there will be is there.
    bool is_baked() const { return !m_map_job.is_busy(); }
    /// Stop everything: at once.
    void stop();

    const Request& request() const { return m_request; }

private:
    void read_mesh(const std::string& path);
    void read_light(const std::string& path);
    void read_map(const std::string& path);

    Request m_request;
    const std::shared_ptr<Warnings> m_warnings = std::make_shared<Warnings>();
    MeshPointer m_mesh;
    LightPointer m_light;
    std::string m_basis; ///< of the map that was baked last
    std::string m_map_activity;
    const int m_threads; ///< for what takes long: one core stays with the window
    Job<MeshPointer> m_mesh_job;
    Job<MapPointer> m_map_job;
    Job<LightPointer> m_light_job;
};

} // namespace vmlight::view
