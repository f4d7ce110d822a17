// SPDX-License-Identifier: Apache-2.0
/// What vmview is asked for on its command line.
#pragma once

#include <vmlight/frame/camera.h>
#include <vmlight/frame/render.h>
#include <vmlight/frame/strand_specular.h>
#include <vmlight/frame/traced_light.h>
#include <vmlight/image/display.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/stage/recipe/recipe.h>

#include <string>
#include <vector>

namespace vmlight::view {

struct ViewParams
{
    std::string background = "none";
    double background_blur = 0;
    bool white = false, headless = false;
    /// Strands beside the mesh.
    std::vector<std::string> object;
    /// Of strands, whose files have no materials: linear R, G, B; empty for white.
    std::vector<double> strand_color;
    std::string show = "lit";
    int bench = 0;
    bool gl_debug = false;

    template <class Visit> void visit(Visit&& field)
    {
        field("background", background,
              Choices { { { "none", "nothing: black in the window, transparent in a file" },
                          { "environment", "the environment" } } },
              "What is behind; the environment lights in any case");
        field("background_blur", background_blur, Range { 0, 60 }, "Blur of the environment behind, in degrees");
        field("white", white, Flag {}, "Show all surfaces white: ignore the materials of the mesh");
        field("object", object, Paths {},
              "Strands beside the mesh, such as its hair; each in the way of the other's light");
        field("strand_color", strand_color, Numbers { 3 },
              "Colour of strands, linear, such as 0.3,0.15,0.05; default: white");
        field("show", show,
              Choices { { { "lit", "the mesh as the light falls on it" },
                          { "visibility", "V" },
                          { "direction", "B as a colour" },
                          { "ratio", "|B| / V: how narrow the visible part of the sky is" },
                          { "error", "the standard error of V, if the map has it" },
                          { "density", "texels per area, relative to their mean" },
                          { "checker", "a checkerboard of the UVs" } } },
              "What the surface shows");
        field("headless", headless, Flag {}, "Without a window or a display server; -o implies it");
        field("bench", bench, Range { 1, 100000, "none", 0 },
              advanced("Draw as many frames without a window, the object turning, and print the milliseconds of one"));
        field("gl_debug", gl_debug, Flag {}, advanced("Let OpenGL check each call, and fail if one is wrong"));
    }
};

struct Request
{
    VismapRecipe mesh; ///< its path may be "": nothing is open yet
    std::string vismap; ///< "": it is baked
    std::string environment; ///< "": none
    CfemRecipe filter;
    LightmapParams light;
    TraceParams trace;
    SpecularParams specular;
    CameraParams camera;
    RenderParams render;
    ViewParams view;
    DisplayParams display;
    std::string output; ///< "": a window
    bool size_given = false, model_given = false, display_given = false, exposure_given = false;
    bool is_auto_exposed = false;

    bool has_window() const { return output.empty() && !view.headless && view.bench == 0; }
};

/// What is wrong with the request as a whole, or "".
std::string request_fault(const Request& request);

/// Why no value of the flag `name` can change what is seen, given the others, or "" if it can. In a window nothing is
/// final but what the file decides.
std::string unused_reason(const Request& request, const std::string& name);

} // namespace vmlight::view
