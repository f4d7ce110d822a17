// SPDX-License-Identifier: Apache-2.0
/// What a mesh file says of its surfaces, as far as it can change light or visibility.
#pragma once

#include <Imath/ImathColor.h>
#include <Imath/ImathMatrix.h>

#include <cstdint>
#include <memory>
#include <string>

namespace vmlight {

/// An image that a material names, and how to look it up.
struct MaterialTexture
{
    /// The file, as the mesh's path is from the working folder; "" if there is none, or it is in `embedded`.
    std::string path;
    /// Which bytes of that file are an image file (PNG, JPEG, ...): all if `length` is 0.
    uint64_t offset = 0, length = 0;
    /// A whole image file that is written as text in the mesh file; nullptr if there is none.
    std::shared_ptr<const std::string> embedded;
    /// Why there is none, though the mesh file names one; "" else.
    std::string missing;
    /// The UV set it is looked up with; 0 is the first.
    int uv_set = 0;
    /// What is beyond [0, 1]: "periodic", "clamp" or "mirror", as OIIO's TextureSystem names it.
    std::string wrap_s = "periodic", wrap_t = "periodic";
    /// Nearest texel, without interpolation.
    bool is_nearest = false;
    /// From the mesh's UVs (v up) to the texture's (v up); row vectors, as everywhere in Imath.
    Imath::M33d uv_transform;

    bool exists() const { return embedded || !path.empty(); }
};

enum class AlphaMode
{
    opaque, ///< alpha is ignored
    mask, ///< opaque where alpha is at least the cutoff, else not there
    blend ///< alpha is how much of the light is stopped
};

/// A metallic-roughness material, as glTF 2.0 has it; other formats fill in what they know.
struct Material
{
    std::string name;
    /// Linear, Rec.709 primaries; the texture is multiplied by it.
    Imath::Color4f base_color { 1, 1, 1, 1 };
    MaterialTexture base_color_texture;
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5f;
    /// An image of opacity in its own right, as OBJ's `map_d`: its red channel multiplies alpha.
    MaterialTexture opacity_texture;
    MaterialTexture normal_texture;
    float normal_scale = 1;
    /// Names a bump or displacement map, which is not read.
    bool has_heights = false;
    MaterialTexture occlusion_texture;
    float occlusion_strength = 1;
    bool is_double_sided = false;
};

} // namespace vmlight
