// SPDX-License-Identifier: Apache-2.0
#include "menus.h"

#include "../render/false_color.h"
#include "app.h"
#include "copied_command.h"

#include <vmlight/frame/lit_object.h>
#include <vmlight/lightmap/model.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <string>
#include <vector>

namespace vmlight::view {
namespace {

// The environments beside the one that is open.
std::vector<std::string> neighbours_of(const std::string& environment)
{
    std::vector<std::string> files, found;
    const std::string folder = OIIO::Filesystem::parent_path(environment);
    OIIO::Filesystem::get_directory_entries(folder.empty() ? "." : folder, files);
    for (const std::string& file : files)
        if (OIIO::Strutil::iends_with(file, ".hdr") || OIIO::Strutil::iends_with(file, ".exr"))
            found.push_back(file);
    std::sort(found.begin(), found.end());
    return found;
}

void draw_files(App& app, const char* label, const std::vector<std::string>& files, const std::string& current)
{
    if (!ImGui::BeginMenu(label, !files.empty()))
        return;
    for (const std::string& file : files) {
        ImGui::PushID(file.c_str());
        if (ImGui::MenuItem(OIIO::Filesystem::filename(file).c_str(), nullptr, file == current))
            app.open(file);
        if (ImGui::IsItemHovered())
            ImGui::SetTooltip("%s", file.c_str());
        ImGui::PopID();
    }
    ImGui::EndMenu();
}

void copy(App& app, const std::string& line)
{
    ImGui::SetClipboardText(line.c_str());
    app.tell("copied: " + line);
}

// What a command asks for: the model that lights the picture, or that was chosen and cannot.
std::string model_of(App& app)
{
    return app.viewport().model().empty() ? app.state().light.model : app.viewport().model();
}

void draw_file_menu(App& app)
{
    const Request& request = app.workshop().request();
    const std::string model = model_of(app);
    if (!ImGui::BeginMenu("File"))
        return;
    // Listed while the menu is open only.
    if (ImGui::BeginMenu("Environment", !request.environment.empty())) {
        for (const std::string& file : neighbours_of(request.environment))
            if (ImGui::MenuItem(OIIO::Filesystem::filename(file).c_str(), nullptr, file == request.environment))
                app.open(file);
        ImGui::EndMenu();
    }
    const std::vector<std::string> meshes = app.settings().recent_mesh, skies = app.settings().recent_environment;
    draw_files(app, "Recent meshes", meshes, request.mesh.mesh);
    draw_files(app, "Recent environments", skies, request.environment);
    ImGui::Separator();
    if (ImGui::MenuItem("Screenshot", "F12"))
        app.take_screenshot();
    const bool can_copy = !request.mesh.mesh.empty() && !request.environment.empty();
    if (ImGui::MenuItem("Copy as makelightmap command", nullptr, false, can_copy))
        copy(app, makelightmap_command(request, app.state(), model));
    if (ImGui::MenuItem("Copy as vmframes command", "Ctrl+C", false, can_copy))
        copy(app, vmframes_command(request, app.state(), model));
    ImGui::Separator();
    if (ImGui::MenuItem("Quit", "Ctrl+Q"))
        app.window().close();
    ImGui::EndMenu();
}

void draw_show_menu(App& app)
{
    ViewState& state = app.state();
    if (!ImGui::BeginMenu("Show"))
        return;
    const auto item = [&](const char* word, const char* label) {
        if (ImGui::MenuItem(label, nullptr, state.show == word))
            state.show = word;
    };
    item("lit", "Light");
    ImGui::Separator();
    for (const FalseColor& color : false_colors())
        item(color.word, color.label);
    item("density", "Texel density");
    item("checker", "UV checker");
    ImGui::Separator();
    ImGui::MenuItem("Environment behind", "B", &state.has_background);
    ImGui::MenuItem("White surfaces", "W", &state.is_white);
    if (ImGui::MenuItem("Reset camera", "Home"))
        app.reset_camera();
    ImGui::EndMenu();
}

void draw_model_menu(App& app)
{
    ViewState& state = app.state();
    if (!ImGui::BeginMenu("Model"))
        return;
    // What they mean is a tooltip: with it beside them the menus would be too wide to lie side by side.
    const auto list = [](std::string& chosen, const char* word, const char* meaning) {
        if (ImGui::MenuItem(word, nullptr, chosen == word))
            chosen = word;
        if (ImGui::IsItemHovered())
            ImGui::SetTooltip("%s", meaning);
    };
    for (const Choice& choice : model_choices().choices)
        list(state.light.model, choice.word, choice.meaning);
    ImGui::Separator();
    if (ImGui::BeginMenu("Compare with")) {
        if (ImGui::MenuItem("nothing", nullptr, state.second.empty()))
            state.second.clear();
        for (const ModelEntry& entry : model_entries())
            list(state.second, entry.name, entry.phrase);
        list(state.second, kReferenceModel, "traced in the background, ever finer");
        ImGui::EndMenu();
    }
    ImGui::Separator();
    const auto trace = [](std::string& word, const char* label, const char* meaning) {
        const bool is_on = word != "off";
        if (ImGui::MenuItem(label, nullptr, is_on))
            word = is_on ? "off" : "auto";
        if (ImGui::IsItemHovered())
            ImGui::SetTooltip("%s", meaning);
    };
    trace(state.trace.suns, "Suns", "small strong lights are split off and traced in the background");
    trace(state.trace.bounce.bounce, "Bounce", "light from surface to surface, traced in the background");
    ImGui::EndMenu();
}

void draw_display_menu(App& app)
{
    ViewState& state = app.state();
    const DisplayConfig& config = app.viewport().config();
    if (!ImGui::BeginMenu("Display"))
        return;
    DisplayChoice now = state.display;
    std::string ignored;
    config.settle(now, ignored);
    for (const std::string& display : config.displays()) {
        if (!ImGui::BeginMenu(display.c_str()))
            continue;
        for (const std::string& view : config.views(display))
            if (ImGui::MenuItem(view.c_str(), nullptr, display == now.display && view == now.view))
                state.display = { display, view, state.display.look };
        ImGui::EndMenu();
    }
    const std::vector<std::string> looks = config.looks();
    if (!looks.empty() && ImGui::BeginMenu("Look")) {
        if (ImGui::MenuItem("the view's own", nullptr, state.display.look.empty()))
            state.display.look.clear();
        for (const std::string& look : looks)
            if (ImGui::MenuItem(look.c_str(), nullptr, state.display.look == look))
                state.display.look = look;
        ImGui::EndMenu();
    }
    ImGui::EndMenu();
}

void handle_key(App& app, const PressedKey& pressed)
{
    ViewState& state = app.state();
    const Request& request = app.workshop().request();
    const bool is_control = pressed.modifiers & GLFW_MOD_CONTROL;
    if (pressed.key == GLFW_KEY_F12)
        app.take_screenshot();
    else if (pressed.key == GLFW_KEY_HOME)
        app.reset_camera();
    else if (is_control && pressed.key == GLFW_KEY_Q)
        app.window().close();
    else if (is_control && pressed.key == GLFW_KEY_C && !request.mesh.mesh.empty() && !request.environment.empty())
        copy(app, vmframes_command(request, state, model_of(app)));
    else if (!is_control && pressed.key == GLFW_KEY_B)
        state.has_background = !state.has_background;
    else if (!is_control && pressed.key == GLFW_KEY_W)
        state.is_white = !state.is_white;
}

} // namespace

void draw_menus(App& app)
{
    for (const PressedKey& pressed : app.window().take_keys())
        if (!ImGui::GetIO().WantTextInput)
            handle_key(app, pressed);
    if (!ImGui::BeginMainMenuBar())
        return;
    draw_file_menu(app);
    draw_show_menu(app);
    draw_model_menu(app);
    draw_display_menu(app);
    ImGui::EndMainMenuBar();
}

} // namespace vmlight::view
