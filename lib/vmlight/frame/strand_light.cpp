// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/strand_light.h>

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/base/text_format.h>
#include <vmlight/cfem/stack.h>
#include <vmlight/cfem/suns.h>
#include <vmlight/image/channels.h>
#include <vmlight/lightmap/model.h>
#include <vmlight/stage/stored_suns.h>
#include <vmlight/vismap/strand_suns.h>

namespace vmlight {

std::string strand_model(const std::string& model)
{
    const ModelEntry* const entry = find_model_entry(model);
    return entry && entry->strand_rank > 0 ? model : "auto";
}

std::string strand_light_fault(const SceneLight& light, const std::string& path)
{
    return is_stack(light.filtered)
        ? ""
        : format("\"{}\": strands need the environment itself, or a stack of makecfem", path);
}

bool filter_for_strands(std::vector<OIIO::ImageBuf>& dst, const SceneLight& light, int nthreads, std::string& error)
{
    const OIIO::ImageBuf& environment = light.filtered.back();
    CfemParams params;
    params.kernel = kStrandKernel;
    params.resolution = { environment.spec().width, environment.spec().height };
    OIIO::ImageBuf around;
    if (!make_cfem(around, environment, params, nthreads)) {
        error = oiio::error_line(around);
        return false;
    }
    around.specmod() = describe_cfem_level(environment.spec(), params, 0);
    dst.assign(light.filtered.begin(), light.filtered.begin() + kStackLevels);
    dst[0] = std::move(around);
    return true;
}

bool StrandSuns::trace(const StrandObject& object, const StrandScene& scene, const VismapRecipe& recipe,
                       const SceneLight& light, const LightmapParams& params, const MakeOptions& options,
                       std::string& error)
{
    Rotation rotation;
    if (!lightmap_rotation(rotation, params, error))
        return false;
    std::string key = suns_text(light.suns);
    for (int i = 0; i < 9; ++i)
        key += format("|{}", rotation[i / 3][i % 3]);
    if (key == m_key)
        return true;
    const Stopwatch timer;
    const Size size = object.layout.size();
    int64_t rays = 0;
    m_key.clear();
    m_light.suns = light.suns;
    m_light.roi = OIIO::ROI(0, size.width, 0, size.height);
    if (!trace_strand_discs(m_light.visibility, object.strands(), scene, object.layout,
                            discs_in_object_space(m_light.suns, rotation), recipe.vismap_params, options.threads, rays,
                            options.step("suns", size.width, size.height))) {
        error = "interrupted";
        return false;
    }
    m_key = key;
    options.report(format("suns: {} in {:.3f} s", count_text(rays, "ray", "rays"), timer()));
    return true;
}

} // namespace vmlight
