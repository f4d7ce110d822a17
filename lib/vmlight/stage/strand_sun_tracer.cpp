// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/strand_sun_tracer.h>

#include <vmlight/base/format.h>

namespace vmlight {

bool StrandSunTracer::prepare(const MapScene& map, const MakeOptions& options, std::string& at, std::string& error)
{
    const VismapRecipe& recipe = map.recipe();
    m_params = recipe.vismap_params;
    if (!read_strand_file(m_strands, m_layout, m_facts.files, recipe, map.stamps(), at, error))
        return false;
    at = "mesh";
    const Size size = m_layout.size();
    if (!map.mesh_hash().empty() && strands_hash(m_strands) != map.mesh_hash())
        error = format("\"{}\": not the strands that the map was baked from; set those with --mesh, or bake it again",
                       recipe.mesh);
    else if (size.width != map.roi().width() || size.height != map.roi().height())
        error = format("\"{}\": its map has {}x{} texels, and this one {}x{}: suns are traced on a map as it was baked",
                       recipe.mesh, size.width, size.height, map.roi().width(), map.roi().height());
    if (!error.empty() || !build_strand_scene(m_scene, m_facts, m_strands, recipe, map.stamps(), options, at, error))
        return false;
    error = map.occluder_fault(m_facts.occluder_hashes);
    if (!error.empty()) {
        at = "occluder";
        error = format("the map was {}", error);
        return false;
    }
    m_bytes = m_scene.bytes() + m_strands.points.size() * (sizeof(Imath::V3d) + sizeof(double));
    return true;
}

bool StrandSunTracer::trace(std::vector<float>& dst, OIIO::cspan<Disc> discs, const MakeOptions& options)
{
    const Size size = m_layout.size();
    return trace_strand_discs(dst, m_strands, m_scene, m_layout, discs, m_params, options.threads, m_rays,
                              options.step("suns", size.width, size.height));
}

} // namespace vmlight
