// SPDX-License-Identifier: Apache-2.0
/// A drawn scene baked and lit, with switches of effects as the stages apply them.
#pragma once

#include "drawn_light.h"

#include <vmlight/cfem/suns.h>
#include <vmlight/lightmap/model_light.h>
#include <vmlight/lightmap/sun_light.h>
#include <vmlight/stage/bake_switches.h>
#include <vmlight/stage/light_effects.h>
#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/normal_map.h>
#include <vmlight/vismap/sun_visibility.h>

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

struct DrawnPicture
{
    OIIO::ImageBuf map, light;
    VismapReport report;
    size_t traced_casters = 0, suns = 0;
    CutoutCounts cutouts;
    CutoutWork cutout_work;

    DrawnPicture(const DrawnScene& drawn, const DrawnLight& drawn_light, const std::string& effects)
    {
        bake(drawn, effects);
        illuminate(drawn, drawn_light, effects);
    }

    /// "map", "light", or "" if all is the same.
    std::string difference(const DrawnPicture& other) const
    {
        return !is_same(map, other.map) ? "map" : !is_same(light, other.light) ? "light" : "";
    }

private:
    static bool is_same(const OIIO::ImageBuf& a, const OIIO::ImageBuf& b)
    {
        return a.roi() == b.roi() && a.localpixels() && b.localpixels()
            && std::memcmp(a.localpixels(), b.localpixels(), size_t(a.spec().image_bytes())) == 0;
    }

    void bake(const DrawnScene& drawn, const std::string& effects)
    {
        VismapRecipe recipe;
        recipe.vismap_params = drawn.params;
        recipe.occluder.resize(drawn.occluders.size());
        recipe.effects = effects;
        const VismapRecipe switched = with_switches(recipe);
        m_params = switched.vismap_params;
        auto scene = std::make_shared<BakeScene>();
        m_scene = scene;
        std::string error;
        EXPECT_TRUE(scene->build(non_owning(drawn.mesh), drawn.occluders, 1, error, scene_choice(switched))) << error;
        if (drawn.normal_map.initialized()) {
            auto normals = std::make_shared<NormalMap>();
            std::vector<std::string> ignored;
            EXPECT_TRUE(normals->decode(drawn.normal_map, drawn.normal_map_params, m_params.size(), 1, ignored, error))
                << error;
            normals->attach(non_owning(drawn.mesh));
            if (!normals->is_flat() || effects == "all")
                m_normals = normals;
        }
        EXPECT_TRUE(make_vismap(map, scene, m_params, &report, 1, {}, 0, m_normals)) << map.geterror();
        for (const CasterReach& caster : scene->reach())
            traced_casters += caster.is_traced(scene->choice(), 0);
        cutouts = scene->occluder().cutouts();
        cutout_work = scene->occluder().cutout_work();
    }

    void illuminate(const DrawnScene& drawn, const DrawnLight& drawn_light, const std::string& effects)
    {
        LightmapRecipe recipe;
        recipe.lightmap_params = drawn_light.params;
        recipe.cfem_params = drawn_light.cfem;
        recipe.effects = effects;
        const LightmapRecipe switched = with_switches(recipe);
        const LightmapParams& params = switched.lightmap_params;
        ShadingModel model;
        SunSplit split;
        SunLight sun_light;
        Rotation rotation;
        std::string error;
        const Environment env(drawn_light.environment);
        std::vector<OIIO::ImageBuf> images;
        EXPECT_TRUE(choose_model(model, params, map.spec(), true, error)) << error;
        EXPECT_TRUE(lightmap_rotation(rotation, params, error)) << error;
        EXPECT_TRUE(!drawn_light.suns || split.find(env, true, error)) << error;
        suns = split.suns().size();
        const Environment rest = split.rest(env);
        EXPECT_TRUE(make_model_light(images, rest, switched.cfem_params, model.light, error, 1)) << error;
        if (suns > 0) {
            std::vector<Disc> discs;
            for (const Sun& sun : split.suns())
                discs.push_back({ rotate(rotation.transposed(), sun.disc.direction), sun.disc.half_angle });
            SunTracer tracer;
            EXPECT_TRUE(tracer.prepare(m_scene, m_params, error, 1, {}, m_normals)) << error;
            sun_light = { split.suns(), map.roi(), {} };
            EXPECT_TRUE(tracer.trace(sun_light.visibility, discs, 1));
        }
        const OIIO::ImageBuf* albedo = drawn_light.albedo.initialized() ? &drawn_light.albedo : nullptr;
        EXPECT_TRUE(make_lightmap(light, map, images, suns > 0 ? &sun_light : nullptr, params, albedo, 1, {}))
            << drawn.mesh.name << ", model " << model.name << ": " << light.geterror();
    }

    VismapParams m_params;
    std::shared_ptr<const BakeScene> m_scene;
    NormalMapPointer m_normals;
};

} // namespace vmlight
