// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh_file.h>

#include <vmlight/mesh_file_ply.h>
#include <vmlight/words.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vmlight {
namespace {

using Imath::V3d;
using OIIO::Strutil::fmt::format;

// The numbers of a line that starts at `at`, at most seven, up to what is none. False if something else follows.
bool numbers_of_line(const char* at, std::vector<double>& numbers)
{
    numbers.clear();
    while (numbers.size() < 7) {
        while (*at == ' ' || *at == '\t' || *at == '\r')
            ++at;
        if (*at == '\0' || *at == '\n' || *at == '#')
            return true;
        char* rest = nullptr;
        numbers.push_back(OIIO::Strutil::strtod(at, &rest));
        if (rest == at)
            return false;
        at = rest;
    }
    return false;
}

// A vertex of 3 numbers, 4 (homogeneous), or 6 (with a colour), as the importer reads them.
bool vertex_of_line(const char* at, std::vector<double>& numbers, V3d& vertex)
{
    if (!numbers_of_line(at, numbers) || (numbers.size() != 3 && numbers.size() != 4 && numbers.size() != 6))
        return false;
    vertex = V3d(numbers[0], numbers[1], numbers[2]);
    if (numbers.size() == 4)
        vertex /= numbers[3];
    return true;
}

template <class Visit> void each_line(const std::string& text, Visit&& visit)
{
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find('\n', begin), text.size());
        if (!visit(begin, end))
            return;
        begin = end + 1;
    }
}

bool starts_with_vertex(const std::string& text, size_t begin)
{
    return text[begin] == 'v' && (text[begin + 1] == ' ' || text[begin + 1] == '\t');
}

std::string with_numbered_vertices(const std::string& text)
{
    std::string numbered;
    size_t number = 0;
    each_line(text, [&](size_t begin, size_t end) {
        if (starts_with_vertex(text, begin)) {
            numbered += format("v {} {} 0\n", number & 0xffff, number >> 16);
            ++number;
        } else {
            numbered.append(text, begin, end - begin + 1);
        }
        return true;
    });
    return numbered;
}

// The importer takes NaN and infinity for 0 here.
std::string texture_coordinate_fault(const std::string& text, size_t begin, size_t end, size_t line)
{
    const auto is_n = [](char c) { return c == 'n' || c == 'N'; };
    if (text.compare(begin, 2, "vt") != 0 || std::none_of(&text[begin], &text[end], is_n))
        return "";
    std::vector<double> numbers;
    numbers_of_line(text.c_str() + begin + 2, numbers);
    if (std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); }))
        return "";
    return reason_line(format("line {} has texture coordinates that are not finite: \"{}\"", line,
                              OIIO::Strutil::strip(text.substr(begin, end - begin))));
}

MeshFile inspect_obj(const std::string& text)
{
    MeshFile file;
    std::vector<double> numbers;
    size_t line = 0;
    bool readable = true;
    each_line(text, [&](size_t begin, size_t end) {
        file.fault = texture_coordinate_fault(text, begin, end, ++line);
        if (readable && starts_with_vertex(text, begin)) {
            V3d vertex;
            readable = vertex_of_line(text.c_str() + begin + 2, numbers, vertex);
            file.positions.push_back(vertex);
        }
        return file.fault.empty();
    });
    if (readable && file.fault.empty() && lie_far_from_origin(file.positions))
        file.stand_in = with_numbered_vertices(text);
    else
        file.positions.clear();
    file.is_numbered = !file.stand_in.empty();
    return file;
}

} // namespace

bool lie_far_from_origin(const std::vector<V3d>& positions)
{
    constexpr double infinity = std::numeric_limits<double>::infinity();
    V3d low(infinity), high(-infinity);
    bool finite = true;
    for (const V3d& p : positions)
        for (int axis = 0; axis < 3; ++axis) {
            finite &= std::isfinite(p[axis]);
            low[axis] = std::min(low[axis], p[axis]);
            high[axis] = std::max(high[axis], p[axis]);
        }
    if (!finite || positions.empty())
        return false;
    double side = 0, reach = 0;
    for (int axis = 0; axis < 3; ++axis) {
        side = std::max(side, high[axis] - low[axis]);
        reach = std::max({ reach, std::abs(low[axis]), std::abs(high[axis]) });
    }
    return side > 0 && reach > kFarFromOrigin * side;
}

MeshFile inspect_mesh_file(const std::string& path)
{
    using namespace OIIO;
    const bool is_obj = Strutil::iequals(Filesystem::extension(path), ".obj");
    std::string bytes(3, '\0');
    bytes.resize(Filesystem::read_bytes(path, bytes.data(), bytes.size()));
    if (!is_obj && bytes != "ply")
        return {};
    bytes.resize(Filesystem::file_size(path));
    bytes.resize(Filesystem::read_bytes(path, bytes.data(), bytes.size()));
    return is_obj ? inspect_obj(bytes) : inspect_ply(bytes);
}

} // namespace vmlight
