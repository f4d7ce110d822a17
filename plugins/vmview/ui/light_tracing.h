// SPDX-License-Identifier: Apache-2.0
/// Suns and the bounce, traced in the background for both textures, one rotation after the other: while the light
/// turns, the last that is done is shown.
#pragma once

#include "../render/renderer.h"
#include "../scene/added_light.h"
#include "../scene/job.h"
#include "view_state.h"

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace vmlight::view {

class LightTracing
{
public:
    /// @param wake     called from other threads when there is something new
    LightTracing(int threads, std::function<void()> wake);

    /// Give `renderer` what is traced, and trace what `state` wants now.
    ///
    /// @param generation   of what the renderer has: another one drops what was traced
    /// @param is_white     the mesh is shown without its materials
    /// @param problem      set if what is wanted could not be traced
    void update(Renderer& renderer, const ViewState& state, int generation, bool is_white, std::string& problem);

    /// Whether light is still to be traced.
    bool is_tracing() const { return m_added_key != m_wanted_key; }
    /// Another number for each light that the renderer was given.
    int count() const { return m_count; }
    /// Stop at once. What was traced is traced again.
    void stop();

private:
    // Light that is added to both textures.
    using Pair = std::array<AddedTexels, 2>;
    void take(Renderer& renderer);
    void drop(Renderer& renderer);

    const int m_threads;
    Job<Pair> m_job;
    std::shared_ptr<AddedLight> m_tracer; // the job's while it runs
    std::string m_tracer_key, m_wanted_key, m_added_key, m_traced_key, m_problem;
    int m_count = 0;
};

} // namespace vmlight::view
