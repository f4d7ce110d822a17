// SPDX-License-Identifier: Apache-2.0
#include "panels.h"

#include "app.h"

#include <vmlight/base/format.h>

#include <imgui.h>

#include <algorithm>
#include <string>

namespace vmlight::view {
namespace {

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove
    | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;

void slide(const char* label, double& value, float low, float high, const char* pattern)
{
    float number = float(value);
    if (ImGui::SliderFloat(label, &number, low, high, pattern))
        value = double(number);
}

void draw_sliders(App& app)
{
    ViewState& state = app.state();
    const float width = ImGui::GetFontSize() * 20;
    ImGui::SetNextWindowPos(ImVec2(8, ImGui::GetFrameHeight() + 8), ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize(ImVec2(width, 0), ImGuiCond_Always);
    ImGui::Begin("View", nullptr, ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoResize);
    ImGui::PushItemWidth(width * 0.55f);
    slide("Exposure", state.light.exposure, -10, 10, "%.2f stops");
    ImGui::SameLine();
    if (ImGui::SmallButton("Auto"))
        app.expose_automatically();
    slide("Turn", state.turn, -180, 180, "%.1f");
    std::vector<double>& sky = state.light.env_rotate;
    double angle = sky.size() == 3 ? sky[1] : 0;
    const double before = angle;
    slide("Environment", angle, -180, 180, "%.1f");
    if (angle != before) {
        sky.resize(3, 0.0);
        sky[1] = angle;
    }
    slide("Elevation", state.camera.elevation, -90, 90, "%.1f");
    slide("Field of view", state.camera.fov, 0, 120, "%.0f");
    ImGui::PopItemWidth();
    ImGui::End();
}

void draw_cursor(App& app)
{
    const CursorTexel& cursor = app.cursor();
    if (!cursor.is_on_mesh && !cursor.is_on_strand)
        return;
    std::string text
        = cursor.is_on_strand ? format("strand {}", cursor.strand) : format("triangle {}", cursor.triangle);
    const MapPointer& map = app.viewport().renderer().map(cursor.figure);
    if (cursor.has_texel && map) {
        text = format("texel {}, {}\nuv {:.4f} {:.4f}\n", cursor.x, cursor.y, cursor.uv.x, cursor.uv.y)
            + describe_texel(*map, cursor.x, cursor.y);
        float rgb[3];
        if (app.viewport().texel(cursor.figure, cursor.x, cursor.y, rgb))
            text += format("\n{} {:.4g} {:.4g} {:.4g}", app.state().show == "lit" ? "light" : "colour", rgb[0], rgb[1],
                           rgb[2]);
    }
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(size.x - 8, ImGui::GetFrameHeight() + 8), ImGuiCond_Always, ImVec2(1, 0));
    ImGui::SetNextWindowBgAlpha(0.7f);
    ImGui::Begin("Texel", nullptr, kFixed | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs);
    ImGui::TextUnformatted(text.c_str());
    ImGui::End();
}

void draw_line(App& app)
{
    const ViewState& state = app.state();
    if (state.second.empty() || state.show != "lit")
        return;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const float x = float(state.wipe) * size.x, y = size.y - 2 * ImGui::GetFrameHeight();
    ImDrawList* list = ImGui::GetBackgroundDrawList();
    list->AddLine(ImVec2(x, 0), ImVec2(x, size.y), IM_COL32(255, 255, 255, 160));
    const std::string left = app.viewport().model();
    list->AddText(ImVec2(x - 8 - ImGui::CalcTextSize(left.c_str()).x, y), IM_COL32_WHITE, left.c_str());
    list->AddText(ImVec2(x + 8, y), IM_COL32_WHITE, state.second.c_str());
}

std::string status_text(App& app)
{
    const Workshop& workshop = app.workshop();
    const Viewport& viewport = app.viewport();
    std::string text;
    const auto add = [&](const std::string& part) { text += (text.empty() ? "" : "   ") + part; };
    if (workshop.request().mesh.mesh.empty())
        add("drop a mesh, a visibility map or an environment here");
    if (const MapPointer& map = viewport.renderer().map(); map && map->samples > 0)
        add(format("map: {} rays", map->samples));
    if (!viewport.model().empty())
        add(format("model: {}", viewport.model()));
    if (const std::string activity = workshop.activity(); !activity.empty())
        add(format("{} {:.0f} %", activity, 100 * workshop.done()));
    else if (const std::string other = viewport.activity(); !other.empty())
        add(other);
    const std::string& problem = viewport.problem().empty() ? app.news() : viewport.problem();
    if (!problem.empty())
        add(problem);
    return text;
}

void draw_status(App& app)
{
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const float height = ImGui::GetFrameHeight();
    ImGui::SetNextWindowPos(ImVec2(0, size.y - height));
    ImGui::SetNextWindowSize(ImVec2(size.x, height));
    ImGui::SetNextWindowBgAlpha(0.6f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(8, 3));
    ImGui::Begin("Status", nullptr, kFixed | ImGuiWindowFlags_NoInputs);
    ImGui::TextUnformatted(status_text(app).c_str());
    ImGui::End();
    ImGui::PopStyleVar();
}

} // namespace

void draw_panels(App& app)
{
    draw_sliders(app);
    draw_cursor(app);
    draw_line(app);
    draw_status(app);
}

} // namespace vmlight::view
