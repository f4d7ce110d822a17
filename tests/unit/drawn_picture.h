// SPDX-License-Identifier: Apache-2.0
/// A drawn scene baked and lit, with switches of effects as the stages apply them.
#pragma once

#include "drawn.h"

#include <vmlight/cfem/suns.h>
#include <vmlight/lightmap/bounce_light.h>
#include <vmlight/lightmap/model_light.h>
#include <vmlight/lightmap/sun_light.h>
#include <vmlight/stage/bake_switches.h>
#include <vmlight/stage/light_effects.h>
#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/light_transport.h>
#include <vmlight/vismap/normal_map.h>
#include <vmlight/vismap/point_visibility.h>
#include <vmlight/vismap/pose_sequence.h>
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
    OIIO::ImageBuf pose, held, again; ///< after `map`, that pose twice and the first again; not initialized without
    VismapReport report;
    size_t traced_casters = 0, suns = 0;
    CutoutCounts cutouts;
    CutoutWork cutout_work;
    int64_t bounce_rays = 0, kept = 0; ///< `kept`: texels of the pose
    bool is_based_anew = false; ///< the pose was baked whole, and `held` has texels of it

    DrawnPicture(const Drawn& drawn, const std::string& effects)
    {
        bake(drawn, effects);
        illuminate(drawn, effects);
    }

    /// What differs, or was not the same twice: "map", "pose", "held", "again", "light", or "" if all is the same: of
    /// further poses, what has not moved.
    std::string difference(const DrawnPicture& other) const
    {
        if (!is_same(map, other.map))
            return "map";
        if (pose.initialized() && !is_same_where_still(pose, other.pose, m_scene->mesh(), *m_posed))
            return "pose";
        if (pose.initialized() && !(is_same(held, pose) && is_same(other.held, other.pose)))
            return "held";
        if (pose.initialized() && !is_same_where_still(again, other.again, m_scene->mesh(), *m_posed))
            return "again";
        return is_same(light, other.light) ? "" : "light";
    }

private:
    static bool is_same(const OIIO::ImageBuf& a, const OIIO::ImageBuf& b)
    {
        return a.roi() == b.roi() && a.localpixels() && b.localpixels()
            && std::memcmp(a.localpixels(), b.localpixels(), size_t(a.spec().image_bytes())) == 0;
    }

    static VismapRecipe recipe_of(const DrawnScene& drawn, const std::string& effects)
    {
        VismapRecipe recipe;
        recipe.vismap_params = drawn.params;
        recipe.occluder.resize(drawn.occluders.size());
        if (drawn.normal_map.initialized())
            recipe.normal_map = "drawn";
        recipe.effects = effects;
        return with_switches(recipe);
    }

    // Keeps its own copy of the mesh.
    static BakeScenePointer build(const DrawnScene& drawn, const VismapRecipe& recipe)
    {
        auto scene = std::make_shared<BakeScene>();
        std::string error;
        EXPECT_TRUE(scene->build(std::make_shared<Mesh>(drawn.mesh), drawn.occluders, 1, error, scene_choice(recipe)))
            << error;
        return scene;
    }

    static NormalMapPointer normals_of(const DrawnScene& drawn, const BakeScenePointer& scene, Size size,
                                       const std::string& effects)
    {
        if (!drawn.normal_map.initialized())
            return nullptr;
        auto normals = std::make_shared<NormalMap>();
        std::vector<std::string> ignored;
        std::string error;
        EXPECT_TRUE(normals->decode(drawn.normal_map, drawn.normal_map_params, size, 1, ignored, error)) << error;
        normals->attach({ scene, &scene->mesh() });
        return normals->is_flat() && effects != "all" ? nullptr : normals;
    }

    void bake(const Drawn& drawn, const std::string& effects)
    {
        const VismapRecipe recipe = recipe_of(drawn.scene, effects);
        m_params = recipe.vismap_params;
        m_scene = build(drawn.scene, recipe);
        m_normals = normals_of(drawn.scene, m_scene, m_params.size(), effects);
        PoseSequence poses(0);
        const MapJob job { m_scene, m_params, 1, {}, 0, m_normals };
        const bool is_sequence = drawn.pose.kind != DrawnPose::none && effects != "all";
        EXPECT_TRUE(is_sequence ? poses.bake(map, job, "first", &report)
                                : make_vismap(map, m_scene, m_params, &report, 1, {}, 0, m_normals))
            << map.geterror();
        for (const CasterReach& caster : m_scene->reach())
            traced_casters += caster.is_traced(m_scene->choice(), 0);
        cutouts = m_scene->occluder().cutouts();
        cutout_work = m_scene->occluder().cutout_work();
        if (drawn.pose.kind == DrawnPose::none)
            return;
        const DrawnScene posed = drawn.pose.of(drawn.scene);
        const BakeScenePointer scene = build(posed, recipe);
        const NormalMapPointer normals = normals_of(posed, scene, m_params.size(), effects);
        m_posed = { scene, &scene->mesh() };
        const MapJob next { scene, m_params, 1, {}, 0, normals };
        EXPECT_TRUE(is_sequence ? poses.bake(pose, next, "second", nullptr)
                                : make_vismap(pose, scene, m_params, nullptr, 1, {}, 0, normals))
            << pose.geterror();
        kept = poses.last().kept;
        held = pose;
        again = map;
        if (!is_sequence)
            return;
        const bool is_whole = poses.last().base.empty();
        EXPECT_TRUE(poses.bake(held, next, "second held", nullptr)) << held.geterror();
        is_based_anew = is_whole && poses.last().kept > 0;
        EXPECT_TRUE(poses.bake(again, job, "first again", nullptr)) << again.geterror();
    }

    void illuminate(const Drawn& drawn, const std::string& effects)
    {
        const DrawnLight& drawn_light = drawn.light;
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
        const SunLight* lit_suns = suns > 0 ? &sun_light : nullptr;
        EXPECT_TRUE(make_lightmap(light, map, images, lit_suns, params, albedo, 1, {}))
            << drawn.scene.mesh.name << ", model " << model.name << ": " << light.geterror();
        if (!drawn_light.bounce || !albedo)
            return;
        const BounceLight bounce = bounced(drawn, effects);
        EXPECT_TRUE(make_lightmap(light, map, images, lit_suns, &bounce, params, albedo, 1, {})) << light.geterror();
    }

    // What `light` sends on, as BounceShading has it; points off the map are white under an even sky.
    BounceLight bounced(const Drawn& drawn, const std::string& effects)
    {
        BakeScenePointer scene = m_scene;
        if (scene->culled_occluder()) {
            VismapRecipe recipe = recipe_of(drawn.scene, effects);
            recipe.cull_occluders = false;
            scene = build(drawn.scene, recipe);
        }
        TransportParams params;
        params.rays = 8;
        params.ground = drawn.light.ground_reflects;
        LightTransport transport;
        std::string error;
        std::vector<float> visibility(size_t(map.spec().image_pixels())), points, baked;
        OIIO::ROI roi = map.roi();
        roi.chbegin = map.spec().channelindex("visibility");
        roi.chend = roi.chbegin + 1;
        EXPECT_TRUE(map.get_pixels(roi, OIIO::TypeFloat, visibility.data()));
        EXPECT_TRUE(transport.prepare(scene, m_params, visibility, params, error, 1, {}, m_normals)) << error;
        EXPECT_TRUE(bake_points(baked, *scene, m_params, transport.surfaces(), 1));
        const size_t channels = point_channels(m_params).size();
        for (size_t i = 0; i < transport.points().size(); ++i)
            points.insert(points.end(), 3, baked[i * channels]);
        BounceLight dst { map.roi(), {} };
        const auto* texels = static_cast<const float*>(light.localpixels());
        const std::vector<float> sent(texels, texels + 3 * visibility.size());
        EXPECT_TRUE(transport.gather(dst.light, sent, points, 1));
        bounce_rays = transport.rays();
        return dst;
    }

    VismapParams m_params;
    BakeScenePointer m_scene;
    std::shared_ptr<const Mesh> m_posed;
    NormalMapPointer m_normals;
};

} // namespace vmlight
