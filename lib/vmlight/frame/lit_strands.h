// SPDX-License-Identifier: Apache-2.0
/// Strands in a frame: their visibility map, and their light, remade for each rotation.
#pragma once

#include <vmlight/frame/frame_object.h>
#include <vmlight/frame/strand_light.h>
#include <vmlight/frame/strand_object.h>
#include <vmlight/trace/strand_scene.h>

#include <memory>
#include <string>
#include <vector>

namespace vmlight {

class LitStrands : public FrameObject
{
public:
    /// Read the strands, with the radius of the recipe.
    bool open(const ObjectRecipe& recipe, const MakeOptions& options, std::string& error) override;

    /// White: files of strands have no materials.
    bool read_materials(const std::string&, const std::string&, const MakeOptions&, std::string&) override
    {
        return true;
    }

    /// Models of surfaces, and the reference, are replaced by the best of strands, with a warning. Suns are traced;
    /// there is no bounce. The light must be a stack, or the environment.
    bool light(const SceneLight& light, const LightmapParams& params, const ReferenceParams& reference,
               const MakeOptions& options, std::string& error, std::string* used = nullptr) override;

private:
    bool prepare_scene(const MakeOptions& options, std::string& error);
    bool prepare_map(const std::string& model, const MakeOptions& options, std::string& error);
    bool bake_map(OIIO::ImageBuf& dst, const MakeOptions& options, std::string& error);
    const std::vector<float>& weights(int, const OIIO::ImageBuf&, int) override { return m_all; }

    StrandObject m_object;
    std::unique_ptr<StrandScene> m_scene;
    std::vector<OIIO::ImageBuf> m_filtered; // the light, by filter_for_strands()
    StrandSuns m_suns;
    const std::vector<float> m_all {}; // every texel counts
    bool m_has_warned = false;
};

} // namespace vmlight
