// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/mtl.h>

#include <vmlight/mesh/import/obj_text.h>
#include <vmlight/mesh/import/side_files.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace vmlight {
namespace {

using namespace obj;
using Imath::C3f;
using OIIO::string_view;

// Up to `most` numbers at the start of `text`, which they are dropped from.
std::vector<float> take_numbers(string_view& text, size_t most)
{
    std::vector<float> numbers;
    while (numbers.size() < most) {
        string_view rest = text;
        TextNumber number;
        if (!parse_number(next_word(rest), number) || !std::isfinite(number.rounded))
            break;
        numbers.push_back(number.rounded);
        text = rest;
    }
    return numbers;
}

// A texture as it is written: options, then a path that may have blanks.
struct Map
{
    MaterialTexture texture;
    float multiplier = 1; ///< of -bm
    bool has_channel = false; ///< names the channel that it is about
};

Map parse_map(string_view arguments, const std::string& folder)
{
    Map map;
    float offset[3] = { 0, 0, 0 }, scale[3] = { 1, 1, 1 };
    const std::map<std::string, float*> vectors { { "-o", offset }, { "-s", scale } };
    const std::map<std::string, size_t> skipped_words {
        { "-blendu", 1 }, { "-blendv", 1 }, { "-cc", 1 }, { "-type", 1 }, { "-colorspace", 1 }
    };
    const std::map<std::string, size_t> skipped_numbers {
        { "-boost", 1 }, { "-mm", 2 }, { "-t", 3 }, { "-texres", 1 }
    };
    string_view rest = arguments;
    for (string_view file = rest; !file.empty(); file = rest) {
        const std::string option = next_word(rest);
        if (const auto vector = vectors.find(option); vector != vectors.end()) {
            const std::vector<float> numbers = take_numbers(rest, 3);
            std::copy(numbers.begin(), numbers.end(), vector->second);
        } else if (option == "-bm") {
            const std::vector<float> numbers = take_numbers(rest, 1);
            map.multiplier = numbers.empty() ? 1 : numbers[0];
        } else if (option == "-clamp") {
            if (next_word(rest) == "on")
                map.texture.wrap_s = map.texture.wrap_t = "clamp";
        } else if (option == "-imfchan") {
            map.has_channel = !next_word(rest).empty();
        } else if (skipped_words.count(option)) {
            for (size_t i = 0; i < skipped_words.at(option); ++i)
                next_word(rest);
        } else if (skipped_numbers.count(option)) {
            take_numbers(rest, skipped_numbers.at(option));
        } else {
            map.texture.path = side_path(folder, name_in(file));
            break;
        }
    }
    map.texture.uv_transform = Imath::M33d(scale[0], 0, 0, 0, scale[1], 0, offset[0], offset[1], 1);
    return map;
}

// What a material's statements say, until all are known.
struct Written
{
    Material material;
    bool has_color = false, has_opacity = false, has_opacity_channel = false;
};

C3f color_of(string_view arguments)
{
    const std::vector<float> numbers = take_numbers(arguments, 3);
    if (numbers.empty()) // a spectrum
        return C3f(1);
    return numbers.size() < 3 ? C3f(numbers[0]) : C3f(numbers[0], numbers[1], numbers[2]);
}

void set_opacity(Written& dst, string_view arguments, bool is_transparency)
{
    const std::vector<float> numbers = take_numbers(arguments, 1);
    if (numbers.empty() || (is_transparency && dst.has_opacity))
        return;
    dst.material.base_color.a = std::clamp(is_transparency ? 1 - numbers[0] : numbers[0], 0.0f, 1.0f);
    dst.has_opacity |= !is_transparency;
}

void read_statement(Written& dst, const Statement& statement, const std::string& folder)
{
    const auto is = [&](const char* keyword) { return OIIO::Strutil::iequals(statement.keyword, keyword); };
    string_view arguments = statement.arguments;
    if (is("Kd")) {
        const C3f color = color_of(without_comment(arguments));
        dst.material.base_color = { color.x, color.y, color.z, dst.material.base_color.a };
        dst.has_color = color != C3f(0);
    } else if (is("d")) {
        OIIO::Strutil::parse_prefix(arguments, "-halo");
        set_opacity(dst, arguments, false);
    } else if (is("Tr")) {
        set_opacity(dst, arguments, true);
    } else if (is("map_Kd")) {
        dst.material.base_color_texture = parse_map(arguments, folder).texture;
    } else if (is("map_d")) {
        const Map map = parse_map(arguments, folder);
        dst.material.opacity_texture = map.texture;
        dst.has_opacity_channel = map.has_channel;
    } else if (is("norm")) {
        const Map map = parse_map(arguments, folder);
        dst.material.normal_texture = map.texture;
        dst.material.normal_scale = map.multiplier;
    } else if (is("bump") || is("map_bump") || is("disp") || is("map_disp")) {
        dst.material.has_heights = parse_map(arguments, folder).texture.exists();
    }
}

Material finished(Written written)
{
    Material& material = written.material;
    if (material.base_color_texture.exists() && !written.has_color)
        material.base_color = { 1, 1, 1, material.base_color.a };
    if (material.base_color.a < 1 || material.opacity_texture.exists())
        material.alpha_mode = AlphaMode::blend;
    if (material.opacity_texture.path == material.base_color_texture.path && !written.has_opacity_channel)
        material.opacity_texture = {};
    return material;
}

} // namespace

void add_mtl_materials(std::vector<Material>& materials, const std::string& text, const std::string& folder)
{
    Statements statements(text);
    Statement statement;
    Written written;
    const auto finish = [&] {
        const auto has_name = [&](const Material& m) { return m.name == written.material.name; };
        const auto known = std::find_if(materials.begin(), materials.end(), has_name);
        if (written.material.name.empty())
            return;
        if (known == materials.end())
            materials.push_back(finished(written));
        else
            *known = finished(written);
    };
    while (statements.next(statement)) {
        if (statement.keyword == "newmtl") {
            finish();
            written = {};
            written.material.name = name_in(statement.arguments);
        } else {
            read_statement(written, statement, folder);
        }
    }
    finish();
}

} // namespace vmlight
