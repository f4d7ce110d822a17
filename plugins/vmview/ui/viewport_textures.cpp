// SPDX-License-Identifier: Apache-2.0
// The textures of the two halves: what they are made for, and who makes them.
#include "viewport.h"

#include "../render/lighting.h"
#include "../scene/loading.h"
#include "params_key.h"

#include <vmlight/base/format.h>
#include <vmlight/frame/frame_object.h>
#include <vmlight/frame/strand_light.h>

#include <OpenImageIO/imagebufalgo.h>

#include <utility>

namespace vmlight::view {
namespace {

std::vector<float> three_channels(const OIIO::ImageBuf& image)
{
    const OIIO::ImageBuf rgb = OIIO::ImageBufAlgo::channels(image, 3, {});
    std::vector<float> pixels(3 * rgb.spec().image_pixels());
    rgb.get_pixels(rgb.roi(), OIIO::TypeFloat, pixels.data());
    return pixels;
}

} // namespace

void Viewport::start(Slot& slot, const std::string& activity, ImageJob::Work work)
{
    slot.activity = activity;
    slot.job.start(std::move(work));
}

void Viewport::stop(Slot& slot)
{
    slot.job.stop();
    slot.key.clear();
    slot.beside.clear();
    slot.activity.clear();
    slot.problem.clear();
    slot.rest.clear();
}

void Viewport::stop()
{
    for (Slot& slot : m_slots)
        stop(slot);
    m_tracing.stop();
}

std::string Viewport::activity() const
{
    return m_slots[0].job.is_busy() ? m_slots[0].activity
        : m_slots[1].job.is_busy()  ? m_slots[1].activity
        : is_tracing()              ? "trace: light"
                                    : "";
}

// Black, rather than what was asked for before. Whether the texture has changed.
bool Viewport::clear(size_t figure, int index, const std::string& reason)
{
    m_slots[size_t(index)].problem = reason;
    const MapPointer& map = m_renderer.map(figure);
    if (map)
        m_renderer.set_texture(index, std::vector<float>(3 * map->weights.size()).data(), false, figure);
    return bool(map);
}

bool Viewport::show_or_clear(size_t figure, int index, const std::string& word, const LightmapParams& params)
{
    std::string reason;
    return show_figure(m_renderer, figure, index, word, params, reason) || clear(figure, index, reason);
}

// Whether the texture has changed.
bool Viewport::refresh_texture(int index, const ViewState& state, const std::string& word, const std::string& asked)
{
    Slot& slot = m_slots[size_t(index)];
    const bool needs_light = is_light(word);
    if (!m_renderer.mesh() || !m_renderer.map() || !m_map_problem.empty() || (needs_light && !m_renderer.light()))
        return false;
    const std::string model = m_renderer.mesh()->is_strands() ? strand_model(asked) : asked;
    LightmapParams params;
    if (!light_params(params, state.light, state.turn, m_problem))
        return false;
    params.model = model;
    const std::string key = format("{}|{}|", m_generation, word) + (needs_light ? key_of(params) : "");
    bool changed = false;
    const bool has_other = slot.added != m_tracing.count() && needs_light && model != kReferenceModel;
    slot.added = m_tracing.count();
    if (key == slot.key && has_other && !slot.rest.empty()) {
        m_renderer.set_texture(index, slot.rest.data(), true);
        changed = true;
    } else if (key != slot.key || (has_other && has_relight_shader(slot.used))) {
        slot.job.stop();
        slot.key = key;
        slot.rest.clear();
        slot.problem.clear();
        slot.used = needs_light ? model : "";
        ShadingModel chosen;
        std::string reason;
        if (needs_light && model == kReferenceModel) {
            if (m_renderer.light()->light.environment.initialized())
                start(slot, "trace: reference",
                      reference_work(m_renderer.mesh(), m_renderer.map(), m_renderer.light(), params, m_threads));
            else
                changed = clear(0, index,
                                "a traced reference needs the environment itself, and this is only its filtered map");
        } else if (needs_light && !model_for(chosen, model, *m_renderer.map(), *m_renderer.light(), reason)) {
            slot.used.clear();
            changed = clear(0, index, reason);
        } else if (needs_light && !has_relight_shader(chosen.name)) {
            slot.used = params.model = chosen.name;
            start(slot, format("light: {}", params.model),
                  relight_work(m_renderer.map(), m_renderer.light(), params, m_threads));
        } else {
            if (needs_light)
                slot.used = params.model = chosen.name;
            changed = show_or_clear(0, index, word, params);
        }
    }
    if (const auto result = slot.job.take()) {
        if (!result->error.empty() && result->error != "interrupted")
            changed = clear(0, index, result->error);
        else if (result->error.empty()) {
            slot.rest = three_channels(result->value);
            m_renderer.set_texture(index, slot.rest.data(), model != kReferenceModel);
            changed = true;
        }
    }
    // What is beside it is lit at once, whatever its model does.
    const std::string beside = format("{}|{}", key, m_tracing.count());
    if (beside != slot.beside) {
        slot.beside = beside;
        for (size_t figure = 1; figure < m_renderer.figures(); ++figure)
            changed |= show_or_clear(figure, index, word, params);
    }
    if (m_problem.empty())
        m_problem = slot.problem;
    return changed;
}

} // namespace vmlight::view
