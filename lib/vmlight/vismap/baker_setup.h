// SPDX-License-Identifier: Apache-2.0
/// What the tiles of a map share, and what a thread needs to bake one: VismapBaker's own.
#pragma once

#include <vmlight/math/sampling.h>
#include <vmlight/trace/surface.h>
#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/ground_of.h>
#include <vmlight/vismap/sun_visibility.h>
#include <vmlight/vismap/visibility_integrator.h>

#include <utility>
#include <vector>

namespace vmlight {

struct VismapBaker::Setup
{
    Setup(BakeScenePointer the_scene, UvRaster&& the_raster, OpenTriangles&& the_open, SeamLinks&& the_seams,
          const VismapParams& the_params, const SampleCount& the_error, NormalMapPointer the_normal_map,
          const std::vector<Disc>& the_suns)
        : scene(std::move(the_scene))
        , normal_map(std::move(the_normal_map))
        , raster(std::move(the_raster))
        , open(std::move(the_open))
        , seams(std::move(the_seams))
        , params(the_params)
        , error(the_error)
        , has_normal(params.has("normal"))
        , has_error(params.has("error"))
        , has_coverage(params.has("coverage"))
        , basis_count(int(basis_channels(params).size()))
        , suns(the_suns)
        , sun_samples(suns.begin(), suns.end())
        , ground(ground_of(*scene, params))
        , pattern(params.sampler, params.samples, params.measure == "uniform")
    {
    }
    const BakeScenePointer scene;
    const NormalMapPointer normal_map;
    const UvRaster raster;
    const OpenTriangles open;
    const SeamLinks seams;
    const VismapParams params;
    const SampleCount error;
    const bool has_normal, has_error, has_coverage;
    const int basis_count;
    const std::vector<Disc> suns;
    const std::vector<DiscSamples> sun_samples;
    const GroundPlane ground;
    const SamplePattern pattern;
};

class VismapBaker::Scratch
{
public:
    explicit Scratch(const Setup& setup)
        : integrator(setup.scene->occluder(), setup.pattern, setup.params, setup.scene->frame().scale, setup.ground)
        , surface(setup.scene->mesh(), setup.scene->frame())
    {
    }
    TileCover cover;
    VisibilityIntegrator integrator;
    Surface surface;
};

} // namespace vmlight
