// SPDX-License-Identifier: Apache-2.0
#include "light_tracing.h"

#include "../render/lighting.h"
#include "../scene/loading.h"
#include "params_key.h"

#include <vmlight/base/format.h>
#include <vmlight/frame/lit_object.h>

#include <utility>

namespace vmlight::view {
namespace {

using Models = std::array<std::string, 2>;

// The models of both textures; "" for one that nothing is added to. False if both are.
bool wanted_models(Models& dst, const ViewState& state, const Renderer& renderer)
{
    const Models asked { state.light.model, state.second };
    for (size_t i = 0; i < asked.size(); ++i) {
        ShadingModel model;
        std::string ignored; // whoever lights the texture reports it
        // Beside a traced reference strands have the best of their own.
        const bool has_strands = renderer.figures() > 1 || renderer.mesh()->is_strands();
        const std::string own = has_strands && asked[i] == kReferenceModel ? "auto" : asked[i];
        const bool is_lit = !own.empty() && own != kReferenceModel
            && model_for(model, own, *renderer.map(), *renderer.light(), ignored);
        dst[i] = is_lit ? model.name : "";
    }
    return !dst[0].empty() || !dst[1].empty();
}

bool can_trace(const ViewState& state, const Renderer& renderer)
{
    if (!is_light(state.show) || !renderer.mesh() || !renderer.map() || !renderer.light())
        return false;
    const bool has_suns = state.trace.suns != "off" && !renderer.light()->light.suns.empty();
    return (has_suns || state.trace.bounce.bounce != "off") && untraceable_reason(renderer.map()->image.spec()).empty();
}

} // namespace

LightTracing::LightTracing(int threads, std::function<void()> wake)
    : m_threads(threads)
    , m_job(std::move(wake))
{
}

void LightTracing::stop()
{
    m_job.stop();
    m_tracer.reset(); // one that was stopped would not start again
    m_tracer_key.clear();
    m_traced_key.clear();
    m_added_key.clear();
}

void LightTracing::take(Renderer& renderer)
{
    auto result = m_job.take();
    if (!result)
        return;
    if (result->error.empty()) {
        for (int i = 0; i < 2; ++i)
            renderer.add_light(i, std::move(result->value[size_t(i)]));
        ++m_count;
    } else if (result->error != "interrupted") {
        m_problem = result->error;
    }
    m_added_key = m_traced_key; // not tried again
}

void LightTracing::drop(Renderer& renderer)
{
    m_wanted_key.clear();
    if (m_job.is_busy())
        stop();
    m_added_key.clear();
    if (!renderer.has_added())
        return;
    renderer.add_light(0, {});
    renderer.add_light(1, {});
    ++m_count;
}

// A job that is stopped at each movement of the mouse would never end: what is wanted is traced once it is free.
void LightTracing::update(Renderer& renderer, const ViewState& state, int generation, bool is_white,
                          std::string& problem)
{
    take(renderer);
    LightmapParams params;
    Models models;
    if (!can_trace(state, renderer) || !wanted_models(models, state, renderer)
        || !light_params(params, state.light, state.turn, problem)) {
        drop(renderer);
        return;
    }
    const std::string of = format("{}|{}|{}|", generation, state.trace.suns, is_white) + key_of(state.trace.bounce);
    m_wanted_key = of + key_of(params) + models[0] + "|" + models[1];
    if (m_wanted_key == m_added_key && !m_problem.empty())
        problem = m_problem;
    if (m_wanted_key == m_added_key || m_job.is_busy())
        return;
    m_problem.clear();
    m_traced_key = m_wanted_key;
    if (of != m_tracer_key)
        m_tracer
            = std::make_shared<AddedLight>(state.trace, renderer.mesh(), is_white, renderer.map(), renderer.light());
    m_tracer_key = of;
    m_job.start([tracer = m_tracer, params, models, threads = m_threads](const auto& post, const auto& go_on) {
        JobResult<Pair> result;
        result.is_last = true;
        MakeOptions options;
        options.threads = threads;
        options.progress = [go_on](const std::string&, int64_t) { return go_on; };
        for (size_t i = 0; i < models.size() && result.error.empty(); ++i) {
            LightmapParams own = params;
            own.model = models[i];
            if (!models[i].empty())
                tracer->trace(result.value[i], own, options, result.error);
        }
        post(std::move(result));
    });
}

} // namespace vmlight::view
