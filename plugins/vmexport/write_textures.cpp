// SPDX-License-Identifier: Apache-2.0
#include "write_textures.h"

#include "inputs.h"

#include "page/page.h"

#include <vmlight/base/format.h>
#include <vmlight/base/interrupt.h>
#include <vmlight/base/output_file.h>
#include <vmlight/base/text_format.h>
#include <vmlight/export/map_textures.h>
#include <vmlight/export/pack.h>
#include <vmlight/export/sh_textures.h>
#include <vmlight/image/channels.h>
#include <vmlight/image/image_file.h>
#include <vmlight/stage/map_scene.h>
#include <vmlight/stage/recipe/paths.h>
#include <vmlight/uv/udim.h>

#include <OpenImageIO/filesystem.h>

#include <optional>

namespace vmlight::exporting {
namespace {

// More than that of the texels behind the surface is the mesh's fault, not the normal map's.
constexpr double kMostBehind = 0.01;

// "hero" of "maps/hero.1001.exr".
std::string start_of_name(const Request& request, const MapTile& tile)
{
    if (!request.files.name.empty())
        return request.files.name;
    const std::string name = OIIO::Filesystem::filename(recipe_path(tile.path));
    const std::string stem = name.substr(0, name.rfind('.'));
    return tile.is_numbered ? stem.substr(0, stem.rfind('.')) : stem;
}

/// Writes the files of one tile.
class TileExport
{
public:
    TileExport(const Request& request, const MapTile& tile, const MakeOptions& options)
        : m_request(request)
        , m_tile(tile)
        , m_options(options)
    {
    }

    /// Encode all files.
    bool make(std::string& error)
    {
        return read(error) && make_occlusion(error) && make_bent_normal(error) && make_sh(error) && make_lightmap(error)
            && make_gltf(error) && make_html(error);
    }

    bool write(std::string& error) const
    {
        const DeferInterrupts writing;
        for (const Output& output : m_outputs) {
            if (output.half.initialized() ? !write_image(output.half, output.path, { "half" }, {}, error)
                                          : !write_file(output.path, output.bytes, error))
                return false;
            m_options.report(output.path + (output.decode.empty() ? "" : ": " + output.decode));
        }
        return true;
    }

private:
    bool read(std::string& error)
    {
        if (!read_map(m_map, m_tile.path, m_options, error))
            return false;
        const OIIO::ImageSpec& spec = m_map.spec();
        const FileInputs& files = m_request.files;
        if (!files.mesh.empty() && kernel_of(spec) == kCosineKernel) {
            const int udim = m_tile.udim ? m_tile.udim : recipe_of_map(spec).vismap_params.udim;
            if (!read_map_mesh(m_mesh, files.mesh, spec, m_options, error))
                return false;
            m_surface.emplace(*m_mesh, spec.width, spec.height, udim, m_options.threads);
            if (m_surface->covered() == 0) {
                error = format("\"{}\": covers no texel of UDIM tile {}", files.mesh, udim);
                return false;
            }
        }
        if (!m_texels.open(m_map, m_surface ? &*m_surface : nullptr, error)) {
            error = format("\"{}\": {}", m_tile.path, error);
            return false;
        }
        return files.lightmap.empty()
            || read_lightmap(m_light.emplace(), udim_path(files.lightmap, m_tile.udim), spec, m_options, error);
    }

    std::string path_of(const std::string& suffix, const std::string& extension) const
    {
        return format("{}/{}_{}{}.{}", m_request.folder, start_of_name(m_request, m_tile), suffix,
                      m_tile.is_numbered ? "." + std::to_string(m_tile.udim) : "", extension);
    }

    void put(const std::string& suffix, const TextureFile& file)
    {
        m_outputs.push_back({ path_of(suffix, file.extension), file.bytes, {}, file.decode });
    }

    bool put_png(const std::string& suffix, const OIIO::ImageBuf& image, const std::string& decode, std::string& error)
    {
        TextureFile file { "png", "", decode };
        if (!encode_png(file.bytes, image, m_request.params.texture_depth(), error))
            return false;
        put(suffix, file);
        return true;
    }

    void put_half(const std::string& suffix, const OIIO::ImageBuf& image, const std::string& decode)
    {
        m_outputs.push_back({ path_of(suffix, "exr"), "", image, decode });
    }

    bool make_occlusion(std::string& error)
    {
        const ExportParams& params = m_request.params;
        if (!m_request.writes("ao"))
            return true;
        OIIO::ImageBuf occlusion = m_texels.occlusion();
        apply_ao_gamma(occlusion, params.ao_gamma);
        const OcclusionLayout& layout = m_request.target()->occlusion;
        OIIO::ImageBuf texture, base;
        const std::string pack = udim_path(m_request.files.pack, m_tile.udim);
        if (!pack.empty() && !read_image(base, pack, error))
            return false;
        if (!pack_occlusion(texture, occlusion, layout, pack.empty() ? nullptr : &base, error)) {
            error = format("\"{}\": {}", pack, error);
            return false;
        }
        const char* suffix = !pack.empty() && layout.channels == 1 ? "orm" : layout.suffix;
        const std::string channel = texture.nchannels() == 1 ? "" : std::string(1, "RGBA"[layout.channel]) + ": ";
        return put_png(suffix, texture,
                       channel + (params.ao_gamma == 1 ? "AO, linear" : format("AO = value^{:.6g}", params.ao_gamma)),
                       error);
    }

    bool make_bent_normal(std::string& error)
    {
        const ExportParams& params = m_request.params;
        if (!m_request.writes("bent_normal"))
            return true;
        const bool is_tangent = params.space == "tangent", is_up = params.green_is_up(*m_request.target());
        const MapTexels::Directions directions
            = is_tangent ? m_texels.tangent_directions() : m_texels.object_directions();
        if (double(directions.behind) > kMostBehind * double(m_surface ? m_surface->covered() : 1))
            m_options.report_warning(
                format("\"{}\": {:.1f} % of its directions point into the surface of \"{}\": is it "
                       "the mesh that was baked?",
                       m_tile.path, percent_of(directions.behind, m_surface->covered()), m_request.files.mesh));
        return put_png("bent_normal",
                       normal_texture(directions, m_map.spec().width, m_map.spec().height, is_up || !is_tangent),
                       !is_tangent ? "object space, direction = 2 rgb - 1"
                           : is_up ? "tangent space, green up, direction = 2 rgb - 1"
                                   : "tangent space, green down, direction = (2 r - 1, 1 - 2 g, 2 b - 1)",
                       error);
    }

    bool make_sh(std::string& error)
    {
        if (!m_request.writes("sh"))
            return true;
        const bool is_png = m_request.params.sh_file == "png";
        std::vector<OIIO::ImageBuf> textures = sh_textures(m_map);
        for (int number = 0; number < int(textures.size()); ++number) {
            OIIO::ImageBuf& texture = textures[size_t(number)];
            const std::string suffix = "sh" + std::to_string(number);
            if (is_png)
                fold_sh(texture, number);
            const std::string decode = !is_png ? ""
                : number == 0                  ? "V = r, B = 2 gba - 1"
                                               : format("T = rgba - {}", double(kShBound));
            if (!is_png)
                put_half(suffix, texture, decode);
            else if (!put_png(suffix, texture, decode, error))
                return false;
        }
        return true;
    }

    bool make_lightmap(std::string& error)
    {
        const ExportParams& params = m_request.params;
        if (!m_light || m_request.folder.empty())
            return true;
        if (params.lightmap_encoding == "half") {
            put_half("lightmap", *m_light, "linear Rec.709");
            return true;
        }
        std::vector<LightmapFile> files;
        if (!encode_lightmap(files, *m_light, params.lightmap_encoding, params.rgbm_range, params.texture_depth(),
                             error)) {
            error = format("\"{}\": {}", udim_path(m_request.files.lightmap, m_tile.udim), error);
            return false;
        }
        for (const LightmapFile& file : files)
            put("lightmap" + file.suffix, file.texture);
        return true;
    }

    bool make_gltf(std::string& error)
    {
        const std::string& path = m_request.files.gltf;
        if (path.empty())
            return true;
        std::string bytes;
        int64_t cut_off = 0;
        if (!make_lit_gltf(bytes, *m_mesh, m_texels.occlusion(), m_light ? &*m_light : nullptr, m_request.gltf_light,
                           cut_off, error)) {
            error = format("\"{}\": {}", path, error);
            return false;
        }
        if (cut_off > 0)
            m_options.report_warning(format("\"{}\": {} brighter than 1, which unlit surfaces cannot be", path,
                                            count_text(cut_off, "texel is", "texels are")));
        m_outputs.push_back({ path, std::move(bytes), {}, "" });
        return true;
    }

    bool make_html(std::string& error)
    {
        const std::string& path = m_request.files.html;
        if (path.empty())
            return true;
        std::vector<PageLight> lights;
        for (const std::string& environment : m_request.files.environment)
            if (!read_page_light(lights.emplace_back(), environment, m_request.filter, m_options, error))
                return false;
        m_outputs.push_back({ path, make_page(*m_mesh, m_texels, *m_surface, lights), {}, "" });
        return true;
    }

    struct Output
    {
        std::string path, bytes;
        /// Instead of bytes, if it is there: an image to be written as EXR.
        OIIO::ImageBuf half;
        std::string decode;
    };
    const Request& m_request;
    const MapTile& m_tile;
    const MakeOptions& m_options;
    OIIO::ImageBuf m_map;
    std::shared_ptr<const Mesh> m_mesh;
    std::optional<TexelSurface> m_surface;
    MapTexels m_texels;
    std::optional<OIIO::ImageBuf> m_light;
    std::vector<Output> m_outputs;
};

} // namespace

bool write_textures(const Request& request, const MakeOptions& options, std::string& error)
{
    std::vector<MapTile> tiles;
    if (!find_tiles(tiles, request.vismap, error))
        return false;
    for (const MapTile& tile : tiles) {
        TileExport files(request, tile, options);
        if (interrupted()) {
            error = "interrupted";
            return false;
        }
        if (!files.make(error))
            return false;
        if (!request.folder.empty() && !OIIO::Filesystem::is_directory(request.folder)
            && !OIIO::Filesystem::create_directory(request.folder, error)) {
            error = format("\"{}\": {}", request.folder, error);
            return false;
        }
        if (!files.write(error))
            return false;
    }
    return true;
}

} // namespace vmlight::exporting
