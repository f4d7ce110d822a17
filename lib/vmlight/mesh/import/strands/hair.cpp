// SPDX-License-Identifier: Apache-2.0
/// Cem Yuksel's HAIR: a header of 128 bytes, then those arrays that its bits name, in their order.
/// Source: C. Yuksel, "HAIR File Format", cemyuksel.com/research/hairmodels.
#include <vmlight/base/format.h>
#include <vmlight/mesh/import/strands/binary_reader.h>
#include <vmlight/mesh/import/strands/strand_format.h>

#include <OpenImageIO/strutil.h>

#include <numeric>
#include <vector>

namespace vmlight {
namespace {

constexpr uint64_t kHairHeader = 128;
enum HairArrays : uint32_t
{
    kSegments = 1,
    kPoints = 2,
    kThickness = 4
};

} // namespace

bool is_hair(const FileHead& head)
{
    return OIIO::Strutil::starts_with(head.bytes, "HAIR");
}

bool read_hair(Strands& dst, const StrandRequest& request, std::string& error)
{
    const std::string bytes = file_bytes(request.path);
    const BinaryReader file(bytes);
    if (!is_hair(request.head) || !file.has(0, kHairHeader, 1)) {
        error = is_hair(request.head)
            ? format("ends early: {} bytes, shorter than its header of {}", file.size(), kHairHeader)
            : "not HAIR: does not start with \"HAIR\"";
        return false;
    }
    const auto strands = file.at<uint32_t>(4), points = file.at<uint32_t>(8), arrays = file.at<uint32_t>(12);
    const auto segments_of_all = file.at<uint32_t>(16);
    const auto thickness_of_all = file.at<float>(20);
    if (!(arrays & kPoints)) {
        error = "has no array of points";
        return false;
    }
    uint64_t at = kHairHeader;
    std::vector<uint64_t> counts(1);
    if (arrays & kSegments) {
        if (!file.has(at, strands, sizeof(uint16_t))) {
            error = format("ends early: {} strands have no room for their segments", strands);
            return false;
        }
        counts.resize(strands);
        for (uint64_t strand = 0; strand < strands; ++strand)
            counts[strand] = file.at<uint16_t>(at + strand * sizeof(uint16_t));
        at += strands * sizeof(uint16_t);
    } else {
        counts[0] = segments_of_all;
    }
    const auto segments_of = [&](uint64_t strand) { return counts[arrays & kSegments ? strand : 0]; };
    uint64_t total = uint64_t(strands) * (uint64_t(segments_of_all) + 1);
    if (arrays & kSegments)
        total = std::accumulate(counts.begin(), counts.end(), uint64_t(strands));
    if (total != points) {
        error = format("its strands have {} points, its header says {}", total, points);
        return false;
    }
    const bool has_thickness = arrays & kThickness;
    if (!file.has(at, points, (has_thickness ? 4 : 3) * sizeof(float))) {
        error = format("ends early: no room for {} points behind byte {}", points, at);
        return false;
    }
    const uint64_t thickness = at + uint64_t(points) * 3 * sizeof(float);
    for (uint64_t point = 0; point < points; ++point) {
        const uint64_t place = at + point * 3 * sizeof(float);
        dst.points.emplace_back(double(file.at<float>(place)), double(file.at<float>(place + 4)),
                                double(file.at<float>(place + 8)));
        if (has_thickness || thickness_of_all != 0)
            dst.radii.push_back(
                0.5 * double(has_thickness ? file.at<float>(thickness + point * sizeof(float)) : thickness_of_all));
    }
    uint64_t end = 0;
    for (uint64_t strand = 0; strand < strands; ++strand)
        dst.ends.push_back(uint32_t(end += segments_of(strand) + 1));
    return true;
}

} // namespace vmlight
