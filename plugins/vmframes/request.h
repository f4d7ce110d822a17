// SPDX-License-Identifier: Apache-2.0
/// What vmframes is asked for on its command line.
#pragma once

#include <vmlight/base/params.h>
#include <vmlight/frame/camera.h>
#include <vmlight/frame/lit_object.h>
#include <vmlight/frame/render.h>
#include <vmlight/frame/strand_specular.h>
#include <vmlight/image/display.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/reference/reference.h>
#include <vmlight/stage/recipe/recipe.h>

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace vmlight::frames {

/// What is around the objects.
struct StageParams
{
    /// Further meshes, lit and in each other's way.
    std::vector<std::string> object;
    std::string ground = "none";
    std::string background = "none";
    double background_blur = 0;
    /// Ignore materials.
    bool white = false;
    /// Of strands, whose files have no materials: linear R, G, B; empty for white.
    std::vector<double> strand_color;

    template <class Visit> void visit(Visit&& field)
    {
        field("object", object, Paths {}, "Another mesh, or strands, in the scene");
        field("ground", ground, Text { "none|white|shadow|FILE" },
              "Ground under the objects: none, white, shadow (its shadow alone, for a comp), or a texture");
        field("background", background, Text { "none|environment|R,G,B" },
              "What is behind: none (transparent), environment, or a linear colour such as 0.2,0.2,0.2, which is "
              "exposed like the rest");
        field("background_blur", background_blur, Range { 0, 60 }, "Blur of the environment behind, in degrees");
        field("white", white, Flag {}, "Show all surfaces white: ignore the materials of the meshes");
        field("strand_color", strand_color, Numbers { 3 },
              "Colour of strands, linear, such as 0.3,0.15,0.05; default: white");
    }
};

/// What turns, once around over all frames.
struct TurnParams
{
    bool turntable = false, turn_environment = false;

    template <class Visit> void visit(Visit&& field)
    {
        field("turntable", turntable, Flag {}, "The objects turn once around over the frames");
        field("turn_environment", turn_environment, Flag {}, "The environment turns once around over the frames");
    }
};

/// Several models in one picture, and what is written besides.
struct SheetParams
{
    std::vector<std::string> wipe, side_by_side;
    std::string contact_sheet, keep;
    double fps = 24;

    template <class Visit> void visit(Visit&& field)
    {
        field("contact_sheet", contact_sheet, Path {}, "Also write all frames in one picture");
        field("fps", fps, Range { 0.01, 240 }, "Frame rate of a film, and of the animation of meshes");
        field("keep", keep, Path {}, "Folder to keep the visibility maps, lightmaps and unwrapped meshes in");
    }
};

/// The command line.
struct Request
{
    ObjectRecipe object;
    /// The environment, "" for none.
    std::string environment;
    CfemRecipe filter;
    LightmapParams light;
    ReferenceParams reference;
    SpecularParams specular;
    CameraParams camera;
    RenderParams render;
    StageParams stage;
    TurnParams turn;
    SheetParams sheet;
    DisplayParams display;
    std::vector<int> frames { 1 };
    bool has_frames = false;
    bool is_auto_exposed = false;
    bool explains = false;
    std::string output;

    /// Whether the mesh, its map or another object has a file for each frame.
    bool moves() const;
    /// The missing_frames_fault() of one of them, or "".
    std::string missing_fault() const;
    /// The same with the files of frame number frames[index]; without frames, as it is.
    Request at(size_t index) const;

    /// The models that one picture shows: that of `light`, or those of a comparison.
    std::vector<std::string> models() const
    {
        return !sheet.wipe.empty()       ? sheet.wipe
            : sheet.side_by_side.empty() ? std::vector<std::string> { light.model }
                                         : sheet.side_by_side;
    }
};

/// Whether the file is of linear light, in layers.
bool is_exr_name(const std::string& path);
/// Whether one file of that name holds all frames.
bool holds_all_frames(const std::string& path);

/// Whether an object is strands.
bool has_strands(const Request& request);

/// What is wrong with the request as a whole, or "".
std::string request_fault(const Request& request);

/// Why no value of the flag `name` can change the pictures, given the others, or "" if it can.
std::string unused_reason(const Request& request, const std::string& name);

} // namespace vmlight::frames
