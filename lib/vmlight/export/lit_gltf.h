// SPDX-License-Identifier: Apache-2.0
/// A mesh as binary glTF with its textures inside: occlusion, and light.
#pragma once

#include <vmlight/base/params.h>
#include <vmlight/mesh/mesh.h>

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight {

/// How glTF, which knows no lightmaps, shows one.
struct GltfLightParams
{
    std::string gltf_light = "emissive";

    template <class Visit> void visit(Visit&& field)
    {
        field("gltf_light", gltf_light,
              Choices { { { "emissive", "black surfaces that send out the light, of any strength" },
                          { "unlit", "surfaces without lighting; light above 1 is cut off" } } },
              "How the light of --lightmap is stored in --gltf");
    }
};

/// Make a .glb: the mesh as write_mesh() writes it, whose materials get
/// - `occlusion`, in R, as occlusionTexture of TEXCOORD_0, at 8 bits;
/// - `light`, as emissiveTexture of TEXCOORD_1, which is TEXCOORD_0 again, on a black surface that reflects nothing,
///   with KHR_materials_emissive_strength for light above 1; or unlit (KHR_materials_unlit), as baseColorTexture. sRGB
///   at 8 bits. The base colours of the mesh are left out: they are in the light.
///
/// Triangles without UVs keep their materials.
/// @param occlusion    one channel
/// @param light        engine_light(), or nullptr
/// @param cut_off      set to how many pixels of unlit light are above 1
/// @returns false, with the reason in `error`, if the mesh has no UVs or a texture cannot be encoded
bool make_lit_gltf(std::string& bytes, const Mesh& mesh, const OIIO::ImageBuf& occlusion, const OIIO::ImageBuf* light,
                   const GltfLightParams& params, int64_t& cut_off, std::string& error);

} // namespace vmlight
