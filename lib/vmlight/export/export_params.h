// SPDX-License-Identifier: Apache-2.0
/// What is exported of a visibility map, and how it is encoded.
#pragma once

#include <vmlight/base/params.h>
#include <vmlight/export/lightmap_encoding.h>
#include <vmlight/export/target.h>
#include <vmlight/image/texture_file.h>

#include <algorithm>
#include <string>
#include <vector>

namespace vmlight {

struct ExportParams
{
    /// The name of an ExportTarget; "" if it was not given.
    std::string target;
    /// `ao`, `bent_normal`, `sh`; empty: what the target has slots for.
    std::vector<std::string> maps;
    std::string depth = "8";
    /// AO is stored as V^(1 / gamma).
    double ao_gamma = 1;
    /// The space of the bent normal.
    std::string space = "tangent";
    /// Direction of green in a tangent-space bent normal: `engine` is the target's.
    std::string green = "engine";
    std::string sh_file = "exr";
    std::string lightmap_encoding = "half";
    /// What RGBM's alpha 1 stands for; kGreatest: the greatest value of the lightmap.
    double rgbm_range = kGreatest;

    static constexpr double kGreatest = 0;

    bool has(const std::string& map) const { return std::find(maps.begin(), maps.end(), map) != maps.end(); }
    TextureDepth texture_depth() const { return depth == "8" ? TextureDepth::Eight : TextureDepth::Sixteen; }
    bool green_is_up(const ExportTarget& of) const { return green == "engine" ? of.green_is_up : green == "up"; }

    template <class Visit> void visit(Visit&& field)
    {
        field("for", target, export_target_choices(), "The engine whose conventions the textures follow");
        field("maps", maps,
              ChoiceSet { { { "ao", "ambient occlusion: V" },
                            { "bent_normal", "the mean open direction: B/|B|" },
                            { "sh", "spherical harmonics of the visibility: V, B, and what --basis sh added" } } },
              "Textures to write; default: those that the engine has slots for");
        field("depth", depth, Choices { { { "8", "whole numbers to 255" }, { "16", "whole numbers to 65535" } } },
              "Bits per channel of PNG files");
        field("ao_gamma", ao_gamma, Range { 0.1, 10 }, "Store AO as V^(1/gamma); engines expect 1: linear");
        field("space", space,
              Choices { { { "tangent", "relative to the mesh's normals and UVs, by MikkTSpace; needs --mesh" },
                          { "object", "x, y and z of the mesh's own space" } } },
              "Space of the bent normal");
        field("green", green,
              Choices { { { "engine", "as the engine has it" },
                          { "up", "OpenGL: green is up in the texture" },
                          { "down", "DirectX: green is down" } } },
              "Direction of the green channel of a tangent-space bent normal");
        field("sh_file", sh_file,
              Choices {
                  { { "exr", "half floats, the numbers themselves" }, { "png", "whole numbers of --depth bits" } } },
              "Files of spherical harmonics");
        field("lightmap_encoding", lightmap_encoding, lightmap_encoding_choices(), "Files of --lightmap");
        field("rgbm_range", rgbm_range, Range { 1e-6, 1e6, "auto", kGreatest },
              "Light that RGBM's alpha 1 stands for; auto: the greatest of the lightmap");
    }
};

} // namespace vmlight
