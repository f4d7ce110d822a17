// SPDX-License-Identifier: Apache-2.0
/// Keys of more than one recipe, or of a recipe and the tools that light without one: their names, values and help.
#pragma once

#include <vmlight/base/params.h>
#include <vmlight/vismap/transport_params.h>

#include <string>

namespace vmlight {

struct CutoutParams
{
    /// `auto`: rays pass where materials are transparent (glTF MASK and BLEND, `d` and `map_d` of MTL files); `off`:
    /// all surfaces are opaque.
    std::string cutouts = "auto";

    template <class Visit> void visit(Visit&& field)
    {
        field("cutouts", cutouts,
              Choices { { { "auto", "as transparent as the materials of the files say" },
                          { "off", "surfaces block light as if they were opaque" } } },
              "Whether light passes where materials have an opacity below 1");
    }
};

/// The key of recipes whose effects can be switched.
template <class Visit> void visit_effects(Visit&& field, std::string& effects, const Help& help)
{
    field("effects", effects, Text { "SWITCHES" }, help);
}

/// Keys of both recipes that read an environment and make light.
template <class Visit>
void visit_image(Visit&& field, std::string& layer, std::string& layout, std::string& output_colorspace)
{
    field("layer", layer, Text { "LAYER" },
          advanced("Layer or part of the environment file to read, such as ViewLayer.Combined"));
    field("layout", layout,
          Choices { { { "auto", "lat-long; what has the shape of a cube map, a cross or a probe is refused" },
                      { "latlong", "lat-long, whatever the shape" } } },
          advanced("How the environment is laid out"));
    field("output_colorspace", output_colorspace, Text { "SPACE" },
          advanced("Linear colour space of the result; default: the working space"));
}

/// The words of the key `suns`: of a CFEM, and of a lightmap.
inline Choices suns_choices(bool traces)
{
    Choices choices { { { "off", "suns stay in the environment" },
                        { "auto", "small strong lights are split off, to be lit each by its own visibility" } } };
    if (traces) {
        choices.choices[1].meaning = "small strong lights are split off and traced, if the mesh is known";
        choices.choices.push_back({ "on", "the same; an error if the mesh is not known" });
    }
    return choices;
}

/// The key of what traces suns: lightmaps, and frames and views of them.
template <class Visit> void visit_suns(Visit&& field, std::string& suns)
{
    field("suns", suns, suns_choices(true), "Lights with hard shadows, such as the sun");
}

/// Light that surfaces send to each other, once: keys of a lightmap.
struct BounceParams
{
    /// `on`: traced from the meshes of the visibility map; there must be an albedo. `auto`: if there is one, and those
    /// meshes are known.
    std::string bounce = "off";
    /// Rays per texel.
    int bounce_rays = 64;
    /// Albedo of occluders whose materials have no colour; and of the ground.
    double bounce_albedo = 0.5, ground_albedo = 0;

    template <class Visit> void visit(Visit&& field)
    {
        field("bounce", bounce,
              Choices { { { "off", "direct light only" },
                          { "auto",
                            "adds one bounce off the mesh, its occluders and the ground, if the mesh is known and an "
                            "albedo is given" },
                          { "on", "the same; an error without mesh or albedo" } } },
              "Light from surface to surface");
        field("bounce_rays", bounce_rays, TransportParams::kRays, advanced("Rays per texel for the bounce"));
        field("bounce_albedo", bounce_albedo, Range { 0, 1 },
              "Albedo, for the bounce, of occluders whose materials have no colour");
        field("ground_albedo", ground_albedo, Range { 0, 1 }, "Albedo of the visibility map's ground, for the bounce");
    }
};

} // namespace vmlight
