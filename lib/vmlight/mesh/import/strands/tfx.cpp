// SPDX-License-Identifier: Apache-2.0
/// TressFX 4 hair: a header of 160 bytes, then arrays at the offsets that it names.
/// Source: AMD, TressFX 4.1, TressFXFileFormat.h.
#include <vmlight/base/format.h>
#include <vmlight/mesh/import/strands/binary_reader.h>
#include <vmlight/mesh/import/strands/strand_format.h>

namespace vmlight {

bool read_tfx(Strands& dst, const StrandRequest& request, std::string& error)
{
    constexpr uint64_t kHeader = 160, kPoint = 4 * sizeof(float); // x, y, z and the inverse of the mass
    const std::string bytes = file_bytes(request.path);
    const BinaryReader file(bytes);
    if (!file.has(0, kHeader, 1)) {
        error = format("not TressFX: {} bytes, shorter than its header of {}", file.size(), kHeader);
        return false;
    }
    const auto version = file.at<float>(0);
    const auto strands = file.at<uint32_t>(4), points = file.at<uint32_t>(8), offset = file.at<uint32_t>(12);
    if (!(version >= 4 && version < 5))
        error = format("not TressFX 4: its version is {}", version);
    else if (strands == 0 || points < 2)
        error = format("{} strands of {} points: needs at least 1 of 2", strands, points);
    else if (offset < kHeader)
        error = format("the points start at byte {}, within the header of {}", offset, kHeader);
    else if (uint64_t(strands) * points > UINT32_MAX || !file.has(offset, uint64_t(strands) * points, kPoint))
        error = format("ends early: {} strands of {} points from byte {} on need {} bytes, the file has {}", strands,
                       points, offset, offset + double(strands) * double(points) * double(kPoint), file.size());
    if (!error.empty())
        return false;
    dst.points.reserve(size_t(strands) * points);
    for (uint64_t strand = 0; strand < strands; ++strand) {
        for (uint64_t point = 0; point < points; ++point) {
            const uint64_t at = offset + (strand * points + point) * kPoint;
            dst.points.emplace_back(double(file.at<float>(at)), double(file.at<float>(at + 4)),
                                    double(file.at<float>(at + 8)));
        }
        end_strand(dst);
    }
    return true;
}

} // namespace vmlight
