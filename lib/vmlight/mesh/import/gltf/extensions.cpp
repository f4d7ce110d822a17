// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/gltf/extensions.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/mesh/import/gltf/error.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <iterator>

namespace vmlight::gltf {
namespace {

enum class Use
{
    read, ///< by this room
    without_shape, ///< changes neither shapes, nor where those are, nor which are opaque: nothing that a map shows
    replaceable ///< not read; files that do not require it hold the same in another way
};

struct Extension
{
    const char* name; ///< a prefix if it ends in *
    Use use;
};

constexpr Extension kExtensions[] = {
    { "EXT_mesh_gpu_instancing", Use::read },
    { "EXT_meshopt_compression", Use::read },
    { "EXT_texture_avif", Use::read },
    { "EXT_texture_webp", Use::read },
    { "KHR_draco_mesh_compression", Use::read },
    { "KHR_materials_pbrSpecularGlossiness", Use::read },
    { "KHR_mesh_quantization", Use::read },
    { "KHR_node_visibility", Use::read },
    { "KHR_texture_transform", Use::read },
    { "ADOBE_materials_*", Use::without_shape },
    { "EXT_instance_features", Use::without_shape },
    { "EXT_lights_*", Use::without_shape },
    { "EXT_mesh_features", Use::without_shape },
    { "EXT_mesh_manifold", Use::without_shape },
    { "EXT_structural_metadata", Use::without_shape },
    { "KHR_animation_pointer", Use::without_shape },
    { "KHR_audio*", Use::without_shape },
    { "KHR_interactivity", Use::without_shape },
    { "KHR_lights_*", Use::without_shape },
    { "KHR_materials_*", Use::without_shape },
    { "KHR_node_hoverability", Use::without_shape },
    { "KHR_node_selectability", Use::without_shape },
    { "KHR_physics_rigid_bodies", Use::without_shape },
    { "KHR_xmp*", Use::without_shape },
    { "MSFT_packing_*", Use::without_shape },
    { "OMI_*", Use::without_shape },
    { "VRM", Use::without_shape },
    { "VRMC_*", Use::without_shape },
    { "KHR_meshopt_compression", Use::replaceable },
    { "KHR_texture_basisu", Use::replaceable },
    { "MSFT_lod", Use::replaceable },
    { "MSFT_texture_dds", Use::replaceable },
};

bool matches(const std::string& name, OIIO::string_view pattern)
{
    if (!OIIO::Strutil::ends_with(pattern, "*"))
        return name == pattern;
    pattern.remove_suffix(1);
    return OIIO::Strutil::starts_with(name, pattern);
}

// Those of `names` that are neither read nor without effect, each once.
std::vector<std::string> unknown_of(const std::vector<std::string>& names, bool are_required)
{
    std::vector<std::string> unknown;
    for (const std::string& name : names) {
        const bool is_known
            = std::any_of(std::begin(kExtensions), std::end(kExtensions), [&](const Extension& extension) {
                  return matches(name, extension.name) && !(are_required && extension.use == Use::replaceable);
              });
        if (!is_known && std::find(unknown.begin(), unknown.end(), name) == unknown.end())
            unknown.push_back(name);
    }
    return unknown;
}

} // namespace

void check_extensions(const std::vector<std::string>& used, const std::vector<std::string>& required,
                      MeshBuilder& builder)
{
    if (const auto unknown = unknown_of(required, true); !unknown.empty())
        throw Error(format("requires the {} {}, which vmlight does not read: export the mesh without {}",
                           plural(int64_t(unknown.size()), "extension", "extensions"),
                           OIIO::Strutil::join(unknown, ", "), plural(int64_t(unknown.size()), "it", "them")));
    for (const std::string& name : unknown_of(used, false))
        builder.warn(format("uses the extension {}, which vmlight does not read: the geometry may differ", name));
}

} // namespace vmlight::gltf
