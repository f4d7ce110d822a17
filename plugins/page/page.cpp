// SPDX-License-Identifier: Apache-2.0
#include "page.h"

#include "page_text.h"

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/base/text_format.h>
#include <vmlight/cfem/stack.h>
#include <vmlight/frame/scene_light.h>
#include <vmlight/image/color_conversion.h>
#include <vmlight/version.h>

#include <Imath/ImathBox.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace vmlight {
namespace {

using Imath::V3d;
using Imath::V3f;
using nlohmann::json;

std::string base64_text(const void* data, size_t size)
{
    constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const auto* bytes = static_cast<const unsigned char*>(data);
    std::string text;
    text.reserve((size + 2) / 3 * 4);
    for (size_t i = 0; i < size; i += 3) {
        uint32_t triple = 0;
        for (size_t k = 0; k < 3; ++k)
            triple = triple << 8 | (i + k < size ? bytes[i + k] : 0u);
        for (size_t k = 0; k < 4; ++k)
            text += i + k > size ? '=' : kDigits[triple >> (18 - 6 * k) & 63];
    }
    return text;
}

template <class Number> std::string base64_text(const std::vector<Number>& numbers)
{
    return base64_text(numbers.data(), numbers.size() * sizeof(Number));
}

json mesh_json(const Mesh& mesh)
{
    Imath::Box3d bounds;
    for (const V3d& p : mesh.positions)
        bounds.extendBy(p);
    const double radius = bounds.size().length() / 2, scale = radius > 0 ? 1 / radius : 1;
    std::vector<float> positions, uvs;
    std::vector<uint32_t> corners;
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
        const V3d p = (mesh.positions[v] - bounds.center()) * scale;
        positions.insert(positions.end(), { float(p.x), float(p.y), float(p.z) });
        const Imath::V2f uv = has_uv(mesh, v) ? mesh.uvs[v] : Imath::V2f(0);
        uvs.insert(uvs.end(), { uv.x, uv.y });
    }
    for (const auto& triangle : mesh.triangles)
        corners.insert(corners.end(), triangle.begin(), triangle.end());
    return { { "positions", base64_text(positions) },
             { "uvs", base64_text(uvs) },
             { "corners", base64_text(corners) } };
}

// No more than kPageMapSide texels a side: the means of what they cover, of V and B as of normals.
OIIO::ImageBuf reduced(const OIIO::ImageBuf& image, int nthreads)
{
    const OIIO::ImageSpec& spec = image.spec();
    const double scale = std::min(1.0, double(kPageMapSide) / std::max(spec.width, spec.height));
    if (scale == 1)
        return image;
    const OIIO::ROI roi(0, std::max(1, int(std::lround(spec.width * scale))), 0,
                        std::max(1, int(std::lround(spec.height * scale))), 0, 1, 0, spec.nchannels);
    OIIO::ImageBuf small;
    oiio::resize(small, image, roi, nthreads, "box");
    return small;
}

uint16_t whole(double share)
{
    return uint16_t(std::lround(std::clamp(share, 0.0, 1.0) * 65535));
}

// 0 is between two steps: it is the upper one.
uint16_t signed_whole(double value)
{
    return value == 0 ? 32768 : whole((value + 1) / 2);
}

json map_json(const MapTexels& texels, const TexelSurface& surface)
{
    const OIIO::ImageBuf map = reduced(texels.filled_map(), 1), facing = reduced(texels.normals(surface), 1);
    const auto *seen = static_cast<const float*>(map.localpixels()),
               *normal = static_cast<const float*>(facing.localpixels());
    std::vector<uint16_t> packed, normals;
    for (size_t i = 0; i < map.spec().image_pixels(); ++i) {
        const float *t = seen + 4 * i, *n = normal + 3 * i;
        packed.insert(packed.end(),
                      { whole(double(t[0])), signed_whole(double(t[1])), signed_whole(double(t[2])),
                        signed_whole(double(t[3])) });
        normals.insert(normals.end(),
                       { signed_whole(double(n[0])), signed_whole(double(n[1])), signed_whole(double(n[2])), 0 });
    }
    return { { "width", map.spec().width },
             { "height", map.spec().height },
             { "texels", base64_text(packed) },
             { "normals", base64_text(normals) } };
}

json light_json(const PageLight& light)
{
    const CfemLookup& cfem = light.cfem;
    const size_t rows = size_t(cfem.height) + 2, texels = rows * size_t(cfem.pitch);
    std::vector<float> filtered, lobes;
    for (size_t i = 0; i < (rows + 2) * size_t(cfem.pitch); ++i)
        filtered.insert(filtered.end(), &cfem.texels[4 * i], &cfem.texels[4 * i] + 3);
    for (int knot = 0; knot < kLobeKnots; ++knot) {
        // The wider of a pair, but of the last the narrower.
        const int pair = std::min(knot, kLobeKnots - 2);
        const float* from = &light.lobes.texels[kLobeFloats * size_t(pair) * texels + (knot > pair ? 3 : 0)];
        for (size_t i = 0; i < texels; ++i)
            lobes.insert(lobes.end(), from + kLobeFloats * i, from + kLobeFloats * i + 3);
    }
    return { { "name", light.name },
             { "width", cfem.width },
             { "height", cfem.height },
             { "knots", kLobeKnots },
             { "brightest", { cfem.brightest[0], cfem.brightest[1], cfem.brightest[2] } },
             { "cfem", base64_text(filtered) },
             { "lobes", base64_text(lobes) } };
}

std::string html_text(const std::string& text)
{
    std::string result;
    for (const char c : printable_line(text))
        result += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
    return result;
}

// Exposure that makes the mean light of the first environment a middle grey, as the display shows it.
double start_exposure(const PageLight& light)
{
    const float* mean = &light.cfem.texels[4 * size_t(light.cfem.mean_texel())];
    const double level = double(mean[0] + mean[1] + mean[2]) / 3;
    return level > 0 ? std::clamp(std::round(10 * std::log2(0.3 / level)) / 10, -4.0, 4.0) : 0;
}

} // namespace

bool read_page_light(PageLight& dst, const std::string& path, const CfemRecipe& recipe, const MakeOptions& options,
                     std::string& error)
{
    SceneLight light;
    CfemRecipe filter = recipe;
    filter.stack = true;
    filter.cfem_params.resolution = { kPageLightWidth, kPageLightWidth / 2 };
    if (!light.open(path, filter, false, options, error))
        return false;
    if (light.filtered.size() < size_t(kStackImages)) {
        error = format("\"{}\": a CFEM without the other lobes; give the environment, or a stack (makecfem --stack)",
                       path);
        return false;
    }
    const LinearSpace *space = linear_space_named(light.space), *screen = linear_space_named("lin_rec709_scene");
    for (OIIO::ImageBuf& image : light.filtered)
        if (space && space != screen)
            convert_color(image, matrix_conversion(*space, *screen), screen->interop_id, options.threads);
    dst.name = OIIO::Filesystem::filename(path);
    const OIIO::cspan<OIIO::ImageBuf> lobes(light.filtered.data(), kStackLevels);
    if (prepare_cfem(dst.cfem, light.filtered[0], error) && prepare_lobes(dst.lobes, lobes, error))
        return true;
    error = format("\"{}\": {}", path, error);
    return false;
}

std::string make_page(const Mesh& mesh, const MapTexels& texels, const TexelSurface& surface,
                      const std::vector<PageLight>& lights)
{
    json environments = json::array();
    for (const PageLight& light : lights)
        environments.push_back(light_json(light));
    const json scene { { "mesh", mesh_json(mesh) },
                       { "map", map_json(texels, surface) },
                       { "environments", environments },
                       { "exposure", start_exposure(lights[0]) },
                       { "shaders",
                         { { "lookup", page_text::lookup_glsl },
                           { "cfem", page_text::relight_cfem_frag },
                           { "lobe", page_text::relight_lobe_frag },
                           { "vertex", page_text::mesh_vert },
                           { "fragment", page_text::mesh_frag } } } };
    // "</script" in a name would end the element.
    const std::string data
        = OIIO::Strutil::replace(scene.dump(-1, ' ', true, json::error_handler_t::replace), "<", "\\u003c", true);
    std::string page = page_text::page_html;
    for (const auto& [key, text] : { std::pair<const char*, std::string> { "@version@", VMLIGHT_VERSION_STRING },
                                     { "@title@", html_text(OIIO::Filesystem::filename(mesh.name)) },
                                     { "@style@", page_text::page_css },
                                     { "@script@", std::string(page_text::viewer_js) + page_text::controls_js },
                                     { "@scene@", data } })
        page = OIIO::Strutil::replace(page, key, text);
    return page;
}

} // namespace vmlight
