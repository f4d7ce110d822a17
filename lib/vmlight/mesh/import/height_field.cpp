// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/height_field.h>

#include <vmlight/base/available_memory.h>
#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/mesh/import/height_grid.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace vmlight {
namespace {

// The bytes that files start with.
const std::string kSignatures[]
    = { { "\x76\x2f\x31\x01", 4 },  { "II*\0", 4 },        { "MM\0*", 4 }, { "II+\0", 4 }, { "MM\0+", 4 },
        { "\x89PNG\r\n\x1a\n", 8 }, { "\xff\xd8\xff", 3 }, "#?RADIANCE",   "#?RGBE" };

// An image of vmlight's has this in its header, uncompressed, and no other has.
constexpr size_t kHeaderBytes = 1 << 16;

// Numbers that stand for "no height" in other programs are far beyond any.
constexpr float kHighest = 1e30f;

// The channel that has the heights, or -1.
int height_channel(const OIIO::ImageSpec& spec)
{
    if (spec.nchannels == 1)
        return 0;
    for (const char* name : { "height", "Y", "Z" })
        for (int c = 0; c < spec.nchannels; ++c)
            if (OIIO::Strutil::iequals(spec.channel_name(c), name))
                return c;
    return -1;
}

bool is_ours(const std::string& path)
{
    std::string header(kHeaderBytes, '\0');
    header.resize(OIIO::Filesystem::read_bytes(path, header.data(), header.size()));
    return header.find("vmlight:stage") != std::string::npos;
}

std::string size_fault(const OIIO::ImageSpec& spec)
{
    if (spec.width < 2 || spec.height < 2 || spec.depth > 1)
        return format("{}x{}x{} pixels; a height image is flat, and at least 2x2", spec.width, spec.height,
                      std::max(1, spec.depth));
    const double pixels = double(spec.width) * spec.height;
    const double bytes = pixels * (4 + 44 + 2 * 24); // the image, vertices and triangles of a Mesh
    if (pixels > UINT32_MAX || bytes > double(available_memory()))
        return format("{}x{} heights need {:.3g} GB of memory, {:.3g} available", spec.width, spec.height, bytes * 1e-9,
                      double(available_memory()) * 1e-9);
    return "";
}

bool read_heights(HeightGrid& dst, const std::string& path, float scale, std::string& error)
{
    const auto input = OIIO::ImageInput::open(path);
    if (!input) {
        error = format("not an image that can be read: {}", oiio::error_line());
        return false;
    }
    const OIIO::ImageSpec spec = input->spec();
    error = size_fault(spec);
    const int channel = height_channel(spec);
    if (error.empty() && channel < 0)
        error = format("{} channels ({}); a height image has one, or one named height, Y or Z", spec.nchannels,
                       OIIO::Strutil::join(spec.channelnames, ", "));
    if (!error.empty())
        return false;
    dst.columns = spec.width;
    dst.rows = spec.height;
    dst.left = spec.x - spec.full_x;
    dst.top = spec.y - spec.full_y;
    dst.full_columns = spec.full_width;
    dst.full_rows = spec.full_height;
    dst.heights.resize(size_t(spec.width) * size_t(spec.height));
    if (!oiio::has_read(*input, input->read_image(0, 0, channel, channel + 1, OIIO::TypeFloat, dst.heights.data()))) {
        error = oiio::pixels_error(oiio::error_line(*input));
        return false;
    }
    for (size_t i = 0; i < dst.heights.size(); ++i) {
        float& height = dst.heights[i];
        if (std::isnan(height))
            continue;
        height *= scale;
        if (std::abs(height) <= kHighest)
            continue;
        error
            = format("pixel ({}, {}) has the height {}, after the scale; where there is no ground, pixels must be NaN",
                     spec.x + int(i % size_t(spec.width)), spec.y + int(i / size_t(spec.width)), height);
        return false;
    }
    return true;
}

} // namespace

bool is_height_field(const FileHead& head)
{
    return std::any_of(std::begin(kSignatures), std::end(kSignatures),
                       [&](const std::string& signature) { return OIIO::Strutil::starts_with(head.bytes, signature); });
}

bool parse_pixel_spacing(double& dst, const std::string& text, std::string& error)
{
    OIIO::string_view rest(text);
    float spacing = 0;
    const bool is_number = OIIO::Strutil::parse_float(rest, spacing);
    OIIO::Strutil::skip_whitespace(rest);
    if (!is_number || !(spacing > 0) || !std::isfinite(spacing) || !(rest.empty() || rest == "m/px")) {
        error = format("terrain: \"{}\" is not the distance between pixels, such as 1.5m/px or 1.5", text);
        return false;
    }
    // All digits: parse_float() has checked the form.
    dst = OIIO::Strutil::stod(text.substr(0, text.size() - rest.size()));
    return true;
}

bool read_height_field(MeshBuilder& dst, const ImportRequest& request, std::string& error)
{
    const MeshParams& params = dst.params();
    HeightGrid grid;
    if (params.terrain.empty()) {
        error = is_ours(request.path)
            ? "a map that vmlight made, not a mesh: pass the mesh"
            : "an image, not a mesh: to read it as terrain, give the distance between its pixels, as in --terrain "
              "1.5m/px";
        return false;
    }
    if (!parse_pixel_spacing(grid.spacing, params.terrain, error))
        return false;
    if (request.before_open)
        request.before_open(request.path);
    return read_heights(grid, request.path, float(params.height_scale), error) && append_height_grid(dst, grid, error);
}

} // namespace vmlight
