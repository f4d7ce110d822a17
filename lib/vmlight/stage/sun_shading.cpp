// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/sun_shading.h>

#include <vmlight/base/format.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/base/text_format.h>
#include <vmlight/cfem/suns.h>
#include <vmlight/image/channels.h>
#include <vmlight/stage/sun_choice.h>
#include <vmlight/stage/sun_source.h>

namespace vmlight {

std::shared_ptr<SunShading> SunShading::open(const LightmapRecipe& recipe, const OIIO::ImageSpec& vismap,
                                             std::shared_ptr<MapScene> scene, std::string& error,
                                             const RecipeChain& chain)
{
    auto suns = std::make_shared<SunShading>();
    suns->m_recipe = recipe;
    suns->m_stored = stored_suns(vismap);
    suns->m_is_of_strands = kernel_of(vismap) == kStrandKernel;
    if (!scene->has_mesh() && suns->m_stored.empty()) {
        error = with_location(recipe, "suns", chain,
                              why_no_mesh(recipe, recipe.vismap)
                                  + "; or bake what it sees of the suns with makevismap --sun-directions");
        return nullptr;
    }
    suns->m_scene = std::move(scene);
    suns->m_key = "suns\n" + suns->m_scene->key();
    return suns;
}

bool SunShading::prepare(const MakeOptions& options, std::string& error)
{
    if (m_is_of_strands) {
        std::string at;
        const bool good = m_strand_tracer.prepare(*m_scene, options, at, error);
        error = good ? "" : with_location(m_recipe, at, options.chain, error);
        return good;
    }
    return m_scene->prepare(options, error)
        && m_tracer.prepare(m_scene->scene(), m_scene->params(), error, options.threads,
                            options.step("suns", m_scene->roi().width(), m_scene->roi().height()),
                            m_scene->normal_map());
}

bool SunShading::failed() const
{
    return m_prepare.failed() || m_scene->failed()
        || (m_is_of_strands && m_prepare.succeeded() && !m_strand_tracer.is_current());
}

bool SunShading::read_stored(std::vector<float>& dst, const std::vector<int>& channels, const ReadChannel& read,
                             std::string& error) const
{
    std::vector<float> plane;
    dst.resize(size_t(m_scene->roi().width()) * m_scene->roi().height() * channels.size());
    for (size_t k = 0; k < channels.size(); ++k) {
        if (!read(channels[k], plane, error))
            return false;
        for (size_t i = 0; i < plane.size(); ++i)
            dst[i * channels.size() + k] = plane[i];
    }
    return true;
}

bool SunShading::light(SunLight& dst, const std::vector<Sun>& suns, const LightmapParams& params,
                       const ReadChannel& read, const MakeOptions& options, std::string& error)
{
    dst.suns = suns;
    dst.roi = m_scene->roi();
    Rotation rotation;
    if (!lightmap_rotation(rotation, params, error))
        return false;
    if (suns.empty())
        return true;
    const std::vector<Disc> discs = discs_in_object_space(suns, rotation);
    if (const std::vector<int> channels = m_stored.channels_of(discs); !channels.empty()) {
        if (!read_stored(dst.visibility, channels, read, error))
            return false;
        options.report("suns: from the visibility map");
        return true;
    }
    if (!m_scene->has_mesh()) {
        error = with_location(m_recipe, "vismap", options.chain,
                              format("\"{}\": the suns are not among those that it was baked for, {}; they are "
                                     "\"{}\": set --mesh to trace them, or bake the map with these --sun-directions",
                                     m_recipe.vismap, sun_directions_text(m_stored.discs), sun_directions_text(discs)));
        return false;
    }
    if (!m_prepare.run([&](std::string& reason) { return prepare(options, reason); }, error))
        return false;
    const Stopwatch timer;
    if (!(m_is_of_strands ? m_strand_tracer.trace(dst.visibility, discs, options)
                          : m_tracer.trace(dst.visibility, discs, options.threads,
                                           options.step("suns", m_scene->roi().width(), m_scene->roi().height())))) {
        error = "interrupted";
        return false;
    }
    const int64_t rays = m_is_of_strands ? m_strand_tracer.rays() : m_tracer.rays();
    options.report(format("suns: {} in {:.3f} s", count_text(rays, "ray", "rays"), timer()));
    return true;
}

bool find_suns(std::string& text, PixelSource& cfem, std::string& error)
{
    if (auto* source = dynamic_cast<SunSource*>(&cfem))
        return source->find_suns(text, error);
    text = cfem.spec().get_string_attribute(kSunsAttribute);
    if (text != kUnknownSuns)
        return true;
    error = "its suns were split off, and it does not say which: it was saved by a program that read a recipe; make it "
            "with makecfem";
    return false;
}

} // namespace vmlight
