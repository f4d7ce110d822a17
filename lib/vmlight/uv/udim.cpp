// SPDX-License-Identifier: Apache-2.0
#include <vmlight/uv/udim.h>

#include <vmlight/base/format.h>
#include <vmlight/base/frames.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace vmlight {
namespace {

constexpr const char* kPattern = "<UDIM>";
constexpr size_t kDigits = 4;
constexpr int kRows = (kLastUdim - kFirstUdim) / 10;

bool is_udim(int number)
{
    return number >= kFirstUdim && number <= kLastUdim;
}

} // namespace

bool parse_udims(std::vector<int>& dst, const std::string& text, std::string& error)
{
    std::vector<int> numbers;
    // No steps: they are for frames.
    if (text.find('x') != std::string::npos || !parse_frames(numbers, text, error)) {
        error = format("\"{}\" is not a list of UDIM tiles; expected something like 1001-1003,1011", text);
        return false;
    }
    const std::set<int> unique(numbers.begin(), numbers.end());
    for (int number : unique)
        if (!is_udim(number)) {
            error = format("{} is not a UDIM tile; expected {} to {}", number, kFirstUdim, kLastUdim);
            return false;
        }
    dst.assign(unique.begin(), unique.end());
    return true;
}

int udim_from_name(const std::string& path)
{
    const std::string name = OIIO::Filesystem::filename(path);
    const size_t end = name.rfind('.'), begin = end == std::string::npos || end == 0 ? end : name.rfind('.', end - 1);
    if (begin == std::string::npos || begin == 0 || end - begin != kDigits + 1)
        return 0;
    const std::string digits = name.substr(begin + 1, kDigits);
    const bool plain = digits.find_first_not_of("0123456789") == std::string::npos;
    const int number = plain ? OIIO::Strutil::stoi(digits) : 0;
    return is_udim(number) ? number : 0;
}

bool has_udim_pattern(const std::string& path)
{
    return path.find(kPattern) != std::string::npos;
}

std::string udim_path(const std::string& path, int udim)
{
    return OIIO::Strutil::replace(path, kPattern, format("{}", udim), true);
}

std::vector<int> existing_udims(const std::string& path)
{
    const std::string name = OIIO::Filesystem::filename(path);
    const size_t at = name.find(kPattern);
    std::vector<int> found;
    std::vector<std::string> entries;
    const std::string folder = OIIO::Filesystem::parent_path(path);
    if (at == std::string::npos || !OIIO::Filesystem::get_directory_entries(folder.empty() ? "." : folder, entries))
        return found;
    for (const std::string& entry : entries) {
        const std::string file = OIIO::Filesystem::filename(entry);
        const std::string digits = file.size() > at ? file.substr(at, kDigits) : "";
        if (digits.size() != kDigits || digits.find_first_not_of("0123456789") != std::string::npos)
            continue;
        const int number = OIIO::Strutil::stoi(digits);
        if (is_udim(number) && file == udim_path(name, number))
            found.push_back(number);
    }
    std::sort(found.begin(), found.end());
    return found;
}

std::vector<int> mesh_udims(const Mesh& mesh)
{
    std::set<int> tiles;
    if (mesh.uvs.empty())
        return {};
    for (const auto& triangle : mesh.triangles) {
        double low[2] = { 1e30, 1e30 }, high[2] = { -1e30, -1e30 };
        bool finite = true;
        for (uint32_t vertex : triangle)
            for (int axis = 0; axis < 2; ++axis) {
                const double value = double(mesh.uvs[vertex][axis]);
                finite = finite && std::isfinite(value);
                low[axis] = std::min(low[axis], value);
                high[axis] = std::max(high[axis], value);
            }
        if (!finite)
            continue;
        const double most[2] = { 9, double(kRows) };
        int first[2], last[2];
        for (int axis = 0; axis < 2; ++axis) {
            first[axis] = int(std::clamp(std::floor(low[axis] + kUdimBorder), 0.0, most[axis] + 1));
            last[axis] = int(std::clamp(std::ceil(high[axis] - kUdimBorder) - 1, -1.0, most[axis]));
        }
        for (int v = first[1]; v <= last[1]; ++v)
            for (int u = first[0]; u <= last[0]; ++u)
                tiles.insert(kFirstUdim + u + 10 * v);
    }
    return { tiles.begin(), tiles.end() };
}

} // namespace vmlight
