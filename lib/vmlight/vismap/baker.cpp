// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/baker.h>

#include <vmlight/base/format.h>
#include <vmlight/uv/islands.h>
#include <vmlight/vismap/baker_setup.h>
#include <vmlight/vismap/reconstruct.h>
#include <vmlight/vismap/sun_visibility.h>

namespace vmlight {
namespace {

int width_of(const VismapParams& params)
{
    return params.size().width;
}

int height_of(const VismapParams& params)
{
    return params.size().height;
}

// Rays that a map may take: for a target error or a time budget their number is not known yet.
double most_rays(const VismapParams& params)
{
    return double(width_of(params)) * height_of(params) * params.samples;
}

} // namespace

VismapBaker::VismapBaker() = default;
VismapBaker::~VismapBaker() = default;

void VismapBaker::FreeScratch::operator()(Scratch* scratch) const
{
    delete scratch;
}

bool VismapBaker::prepare(BakeScenePointer scene, const VismapParams& params, std::string& error, int nthreads,
                          const Progress& progress, double time_budget, NormalMapPointer normal_map)
{
    if (!check_params(params, error))
        return false;
    if (find_basis(params.basis).accumulator && params.measure != "cosine") {
        error = "basis: " + params.basis + " needs the measure cosine, not " + params.measure;
        return false;
    }
    std::vector<Disc> suns;
    if (!parse_sun_directions(suns, params.sun_directions, error))
        return false;
    if (params.max_distance > scene->choice().reach) {
        error = format("max_distance: {:.6g} is more than the {:.6g} that the scene was built for", params.max_distance,
                       scene->choice().reach);
        return false;
    }
    UvRaster raster(scene->mesh(), width_of(params), height_of(params), params.udim);
    OpenTriangles open;
    if (params.skip_open)
        open.find(*scene, params.max_distance * scene->frame().scale, most_rays(params));
    VismapParams settled = params;
    if (normal_map)
        settled.reconstruct = "off"; // normals that change from texel to texel hide what neighbours share
    SeamLinks seams;
    if (is_reconstructed(settled))
        seams = SeamLinks(scene->mesh(), raster, width_of(params), height_of(params), params.udim);
    SampleCount chosen;
    if (!choose_samples(chosen, *scene, normal_map.get(), raster, open, seams, params, time_budget, nthreads, progress,
                        error))
        return false;
    settled.samples = chosen.samples;
    m_setup = std::make_unique<Setup>(std::move(scene), std::move(raster), std::move(open), std::move(seams), settled,
                                      chosen, std::move(normal_map), suns);
    return true;
}

bool VismapBaker::prepare(const Mesh& mesh, const std::vector<Mesh>& occluders, const VismapParams& params,
                          int nthreads, std::string& error)
{
    auto scene = std::make_shared<BakeScene>();
    return check_params(params, error)
        && scene->build(non_owning(mesh), occluders, nthreads, error, SceneChoice::within(params.max_distance))
        && prepare(std::move(scene), params, error, nthreads);
}

int VismapBaker::width() const
{
    return width_of(m_setup->params);
}

int VismapBaker::height() const
{
    return height_of(m_setup->params);
}

int VismapBaker::channels() const
{
    return before_basis() + m_setup->basis_count + (m_setup->has_coverage ? 1 : 0);
}

int VismapBaker::before_basis() const
{
    return 4 + (m_setup->has_normal ? 3 : 0) + (m_setup->has_error ? 1 : 0) + int(m_setup->suns.size());
}

MarginChannels VismapBaker::margin_channels() const
{
    return margin_channels_of(describe_vismap("", m_setup->params).channelnames);
}

int VismapBaker::tiles_across() const
{
    return m_setup->raster.tiles_across();
}

int VismapBaker::tiles_down() const
{
    return m_setup->raster.tiles_down();
}

const UvRaster& VismapBaker::raster() const
{
    return m_setup->raster;
}

const UvReport& VismapBaker::uv_report() const
{
    return m_setup->raster.report();
}

void VismapBaker::count_islands(UvReport& report) const
{
    vmlight::count_islands(report, m_setup->scene->mesh(), m_setup->raster);
}

const VismapParams& VismapBaker::params() const
{
    return m_setup->params;
}

const SampleCount& VismapBaker::error() const
{
    return m_setup->error;
}

const OpenTriangles& VismapBaker::open() const
{
    return m_setup->open;
}

const SeamLinks& VismapBaker::seams() const
{
    return m_setup->seams;
}

VismapBaker::ScratchPointer VismapBaker::scratch() const
{
    return ScratchPointer(new Scratch(*m_setup));
}

} // namespace vmlight
