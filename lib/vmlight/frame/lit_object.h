// SPDX-License-Identifier: Apache-2.0
/// A mesh in a frame: the visibility maps that light needs, and its light, remade for each rotation.
#pragma once

#include <vmlight/frame/frame_object.h>
#include <vmlight/trace/bake_scene.h>

#include <OpenImageIO/imagebuf.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

class LitObject : public FrameObject
{
public:
    /// Read the mesh. One without UVs, or whose UVs overlap so heavily that they cannot have been made for baking, is
    /// unwrapped, and that is reported; a mesh whose map is given keeps its own.
    bool open(const ObjectRecipe& recipe, const MakeOptions& options, std::string& error) override;
    /// A mesh in memory, with UVs.
    void open(std::shared_ptr<const Mesh> mesh, const VismapParams& params, const TraceParams& trace = {});

    bool read_materials(const std::string& light_space, const std::string& colorconfig, const MakeOptions& options,
                        std::string& error) override;

    /// Suns and the bounce are traced on the object and its occluders, whatever a map that was read was baked with. The
    /// reference has the environment's own suns, and the bounce of a white object among white ones only.
    bool light(const SceneLight& light, const LightmapParams& params, const ReferenceParams& reference,
               const MakeOptions& options, std::string& error, std::string* used = nullptr) override;

private:
    bool prepare_scene(const MakeOptions& options, std::string& error);
    bool prepare_maps(const std::string& model, const MakeOptions& options, std::string& error);
    bool read_maps(const MakeOptions& options, std::string& error);
    bool bake_maps(TileMaps& dst, const std::string& basis, const MakeOptions& options, std::string& error);
    const std::vector<float>& weights(int udim, const OIIO::ImageBuf& map, int nthreads) override;
    bool light_tile(OIIO::ImageBuf& dst, int udim, const OIIO::ImageBuf& map, const SceneLight& light,
                    const LightmapParams& params, const MakeOptions& options, std::string& error);
    bool trace_tile(OIIO::ImageBuf& dst, int udim, const OIIO::ImageBuf& map, const SceneLight& light,
                    const LightmapParams& params, const ReferenceParams& reference, const MakeOptions& options,
                    std::string& error);

    BakeScenePointer m_scene;
    std::map<std::string, std::map<int, std::unique_ptr<TracedLight>>> m_traced; // by basis and tile
    std::map<int, std::vector<float>> m_weights;
};

} // namespace vmlight
