// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/text_format.h>
#include <vmlight/mesh/export/exporter.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <charconv>
#include <cmath>

namespace vmlight {
namespace {

template <class Number> void append_number(std::string& dst, Number value)
{
    char text[40];
    dst += ' ';
    dst.append(text, std::to_chars(text, text + sizeof(text), value).ptr); // the fewest digits that give it back
}

// As a float where it is one: then its digits are fewer.
void append_coordinate(std::string& dst, double value)
{
    if (double(float(value)) == value)
        append_number(dst, float(value));
    else
        append_number(dst, value);
}

void append_points(std::string& dst, const std::vector<Imath::V3d>& points)
{
    for (const Imath::V3d& p : points) {
        dst += 'v';
        for (int axis = 0; axis < 3; ++axis)
            append_coordinate(dst, p[axis]);
        dst += '\n';
    }
}

void append_uv(std::string& dst, const Imath::V2f& uv)
{
    dst += "vt";
    append_number(dst, uv.x);
    append_number(dst, uv.y);
    dst += '\n';
}

// A name as one word: readers end it at a blank.
std::string word(const std::string& name, const std::string& otherwise)
{
    std::string result = printable_line(name);
    for (char& c : result)
        if (c == ' ' || c == '#')
            c = '_';
    return result.empty() ? otherwise : result;
}

// Names of materials are what tells them apart.
std::vector<std::string> material_words(const Mesh& mesh)
{
    std::vector<std::string> words;
    for (size_t i = 0; i < mesh.materials.size(); ++i) {
        std::string name = word(mesh.materials[i].name, "material");
        for (size_t other = 0; other < i; ++other)
            if (words[other] == name)
                name += "_" + std::to_string(i);
        words.push_back(name);
    }
    return words;
}

std::string material_text(const Mesh& mesh, const std::vector<std::string>& words)
{
    std::string text;
    for (size_t i = 0; i < words.size(); ++i) {
        const Imath::Color4f& color = mesh.materials[i].base_color;
        text += "newmtl " + words[i] + "\nKd";
        for (float channel : { color.r, color.g, color.b })
            append_number(text, channel);
        text += "\nd";
        append_number(text, color.a);
        text += "\n";
    }
    return text;
}

} // namespace

std::vector<MeshFile> obj_files(const Mesh& mesh, const std::string& path)
{
    std::vector<MeshFile> files;
    const std::vector<std::string> words = material_words(mesh);
    std::string text = "# vmlight\n";
    if (!words.empty()) {
        const std::string materials = OIIO::Filesystem::replace_extension(path, ".mtl");
        files.push_back({ materials, material_text(mesh, words) });
        text += "mtllib " + OIIO::Filesystem::filename(materials) + "\n";
    }
    text += "o " + word(OIIO::Filesystem::filename(mesh.name), "mesh") + "\n";
    append_points(text, mesh.positions);
    for (size_t vertex = 0; vertex < mesh.uvs.size(); ++vertex)
        append_uv(text, has_uv(mesh, uint32_t(vertex)) ? mesh.uvs[vertex] : Imath::V2f(0));
    for (const Imath::V3f& n : mesh.normals) {
        text += "vn";
        for (int axis = 0; axis < 3; ++axis)
            append_number(text, n[axis]);
        text += '\n';
    }
    uint32_t material = ~0u;
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (!words.empty() && t < mesh.triangle_materials.size() && mesh.triangle_materials[t] != material) {
            material = mesh.triangle_materials[t];
            text += "usemtl " + words[std::min<size_t>(material, words.size() - 1)] + "\n";
        }
        text += 'f';
        for (uint32_t vertex : mesh.triangles[t]) {
            const std::string number = std::to_string(vertex + 1);
            text += " " + number + "/" + (has_uv(mesh, vertex) ? number : "") + "/" + number;
        }
        text += '\n';
    }
    files.push_back({ path, std::move(text) });
    return files;
}

std::vector<MeshFile> obj_strand_files(const Strands& strands, const std::vector<Imath::V2f>& uvs,
                                       const std::string& path)
{
    std::string text = "# vmlight\no " + word(OIIO::Filesystem::filename(strands.name), "strands") + "\n";
    append_points(text, strands.points);
    for (const Imath::V2f& uv : uvs)
        append_uv(text, uv);
    for (size_t strand = 0; strand < strands.count(); ++strand) {
        text += 'l';
        for (size_t p = strands.begin(strand); p < strands.end(strand); ++p) {
            const std::string number = std::to_string(p + 1);
            text += " " + number + "/" + number;
        }
        text += '\n';
    }
    return { { path, std::move(text) } };
}

} // namespace vmlight
