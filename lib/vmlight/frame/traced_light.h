// SPDX-License-Identifier: Apache-2.0
/// The light of an object that no shading model looks up: suns and a bounce, traced as lightmaps have them
/// (stage/sun_shading.h, stage/bounce_shading.h), on meshes in memory.
#pragma once

#include <vmlight/frame/frame_scene.h>
#include <vmlight/frame/scene_light.h>
#include <vmlight/lightmap/bounce_light.h>
#include <vmlight/lightmap/sun_light.h>
#include <vmlight/stage/bounce_shading.h>
#include <vmlight/stage/make_options.h>
#include <vmlight/stage/map_scene.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/stage/sun_shading.h>
#include <vmlight/trace/bake_scene.h>

#include <OpenImageIO/imagebuf.h>

#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace vmlight {

/// What is traced of the light: keys of frames and views, as lightmaps have them, with a help of their own: the mesh is
/// always known, and materials are the albedo.
struct TraceParams
{
    /// As LightmapRecipe::suns, but that the mesh is always known: `auto` and `on` differ for maps that nothing can be
    /// traced on (untraceable_reason()).
    std::string suns = "off";
    BounceParams bounce;

    bool has_any() const { return suns != "off" || bounce.bounce != "off"; }

    template <class Visit> void visit(Visit&& field)
    {
        field("suns", suns,
              Choices { { { "off", "suns stay in the environment" },
                          { "auto", "small strong lights are split off and traced, if the visibility map allows it" },
                          { "on", "the same; an error if it does not" } } },
              "Lights with hard shadows, such as the sun");
        bounce.visit([&](const char* name, auto& value, const auto& allowed, const Help& help) {
            if constexpr (std::is_same_v<std::decay_t<decltype(allowed)>, Choices>)
                field(name, value,
                      Choices { { { "off", "direct light only" },
                                  { "auto", "adds one bounce between all surfaces, coloured by their materials" },
                                  { "on", "the same" } } },
                      help);
            else if (OIIO::string_view(name) == "bounce_albedo")
                field(name, value, allowed, Help("Albedo, for the bounce, of surfaces whose materials have no colour"));
            else
                field(name, value, allowed, help);
        });
    }
};

/// Why nothing can be traced on a visibility map with this header, though its mesh is known, in a clause; or "".
std::string untraceable_reason(const OIIO::ImageSpec& vismap);
/// Switch off what of `params` cannot be traced on the map in a file or recipe, with <UDIM> if it has several tiles, of
/// which the header is read: suns that are `auto`, with a warning. "": the map is to be baked, and all can be.
///
/// @returns false, with the reason in `error`, if suns that are `on`, or a bounce, cannot be traced
bool choose_trace(TraceParams& params, const std::string& vismap, const MakeOptions& options, std::string& error);

/// Of one visibility map. One thread at a time.
class TracedLight
{
public:
    /// @param scene    built
    /// @param udim     the tile of the map
    /// @param surface  of the mesh of `scene`, which sends back what its materials do; those that say no colour have
    ///                 `params.bounce.bounce_albedo`
    /// @param others   the same of the occluders of `scene`, in their order
    TracedLight(const TraceParams& params, BakeScenePointer scene, int udim, FrameSurface surface,
                std::vector<FrameSurface> others);

    /// Trace the suns of `light` at the rotation of `params`, which an earlier call may have done, and sum up the
    /// bounce of what they and the model light. The first call finds the texels' points, and what their rays meet; the
    /// bounce of other light needs no rays.
    ///
    /// @param map      the visibility map, float, in memory: the same for all calls
    /// @returns false, with the reason in `error`, if a parameter is out of range, memory runs out, or the work was
    ///          stopped
    bool light(const OIIO::ImageBuf& map, const SceneLight& light, const LightmapParams& params,
               const MakeOptions& options, std::string& error);

    /// Of the last light(), for make_lightmap(); nullptr if there is none.
    const SunLight* suns() const { return m_suns.suns.empty() ? nullptr : &m_suns; }
    const BounceLight* bounce() const { return m_bounce.light.empty() ? nullptr : &m_bounce; }

    /// Whether light() will go on to fail, as it does once its first call was stopped.
    bool failed() const;

private:
    bool trace_suns(const OIIO::ImageBuf& map, const SceneLight& light, const LightmapParams& params,
                    const MakeOptions& options, std::string& error);
    BounceShading& bounce_shading();
    bool add_bounce(const OIIO::ImageBuf& map, const SceneLight& light, const LightmapParams& params,
                    const MakeOptions& options, std::string& error);

    const TraceParams m_params;
    const BakeScenePointer m_bake;
    const int m_udim;
    const FrameSurface m_surface;
    const std::vector<FrameSurface> m_others;
    std::shared_ptr<MapScene> m_scene;
    std::shared_ptr<SunShading> m_sun_shading;
    std::shared_ptr<BounceShading> m_bounce_shading;
    OIIO::ImageBuf m_albedo; ///< texel_albedo()
    std::string m_suns_key; ///< what m_suns was traced for
    SunLight m_suns;
    BounceLight m_bounce;
};

} // namespace vmlight
