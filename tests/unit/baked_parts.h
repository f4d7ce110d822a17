// SPDX-License-Identifier: Apache-2.0
/// Parts of maps in memory, baked and joined.
#pragma once

#include "drawn_map.h"

#include <vmlight/vismap/bake_parts.h>
#include <vmlight/vismap/join_parts.h>

#include <OpenImageIO/imagebuf.h>

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

namespace vmlight {

/// By their numbers.
using Parts = std::map<int, OIIO::ImageBuf>;

/// As one machine bakes them.
inline Parts baked_parts(const BakeScenePointer& scene, const VismapParams& params, int count,
                         const std::vector<int>& which, int threads = 2, VismapReport* report = nullptr)
{
    Parts parts;
    PartsJob job { { scene, params, threads, {}, 0, nullptr }, count, which, {}, {}, {} };
    job.write = [&](int part, const OIIO::ImageBuf& image, std::string&) {
        parts[part].copy(image);
        return true;
    };
    VismapReport counts;
    std::string error;
    EXPECT_TRUE(bake_parts(job, counts, error)) << error;
    if (report)
        *report = counts;
    return parts;
}

/// What is wrong with parts; "" if they are joined.
inline std::string join_fault(OIIO::ImageBuf& dst, const Parts& parts, int count)
{
    JoinReport report;
    std::string error;
    const auto read = [&](OIIO::ImageBuf& part, int index, std::string&) { return part.copy(parts.at(index)); };
    return join_parts(rows_into(dst), count, read, report, error) ? "" : error;
}

} // namespace vmlight
