// SPDX-License-Identifier: Apache-2.0
/// What vmexport is asked for on its command line.
#pragma once

#include <vmlight/base/params.h>
#include <vmlight/export/export_params.h>
#include <vmlight/export/lit_gltf.h>
#include <vmlight/stage/recipe/recipe.h>

#include <string>
#include <vector>

namespace vmlight::exporting {

/// Files beside the map.
struct FileInputs
{
    std::string mesh, lightmap, pack, name, gltf, html;
    std::vector<std::string> environment;

    template <class Visit> void visit(Visit&& field)
    {
        field("mesh", mesh, Path {},
              "The mesh that the map was baked from, for tangents, the charts' borders and --gltf");
        field("lightmap", lightmap, Path {},
              "Lightmap of makelightmap to encode too; in --gltf, the light that it shows");
        field("pack", pack, Path {},
              "Texture whose channel for occlusion is replaced by AO, such as an ORM texture or a mask map");
        field("name", name, Text { "NAME" }, "Start of the names of the files; default: that of the map");
        field("gltf", gltf, Path {}, "Also write the mesh, with its AO, as binary glTF (.glb)");
        field("html", html, Path {},
              "Also write a page (.html) that shows the mesh and turns its light, in any browser");
        field("environment", environment, Paths {}, "Environment that lights the page of --html");
    }
};

/// The command line.
struct Request
{
    /// A visibility map; with `<UDIM>`, all tiles.
    std::string vismap;
    FileInputs files;
    ExportParams params;
    GltfLightParams gltf_light;
    /// How the environments are read.
    CfemRecipe filter;
    /// "" if no textures are written.
    std::string folder;

    const ExportTarget* target() const { return find_export_target(params.target); }
    /// The maps that are asked for, or those of the target.
    bool writes(const std::string& map) const;
};

/// What is wrong with the request as a whole, or "".
std::string request_fault(const Request& request);

/// Why no value of the flag `name` can change the files, given the others, or "" if it can.
std::string unused_reason(const Request& request, const std::string& name);

} // namespace vmlight::exporting
