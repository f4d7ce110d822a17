// SPDX-License-Identifier: Apache-2.0
/// What the texels of a map of strands see of suns: SunTracer, for strands.
#pragma once

#include <vmlight/stage/map_scene.h>
#include <vmlight/stage/strand_files.h>
#include <vmlight/vismap/strand_suns.h>

#include <OpenImageIO/span.h>

#include <cstdint>
#include <string>
#include <vector>

namespace vmlight {

class StrandSunTracer
{
public:
    /// Read the strands and occluders that a map was baked from, once. False, with the recipe's key in `at` and the
    /// reason in `error`, if a file cannot be read or is not the one that was baked, or memory runs out.
    bool prepare(const MapScene& map, const MakeOptions& options, std::string& at, std::string& error);
    /// Trace as trace_strand_discs(). False if the work was stopped.
    bool trace(std::vector<float>& dst, OIIO::cspan<Disc> discs, const MakeOptions& options);

    /// Rays of the last trace().
    int64_t rays() const { return m_rays; }
    /// Whether no file has changed since prepare().
    bool is_current() const { return are_unchanged(m_facts.files); }
    size_t bytes() const { return m_bytes; }

private:
    Strands m_strands;
    StrandLayout m_layout;
    StrandScene m_scene;
    StrandSceneFacts m_facts;
    VismapParams m_params;
    int64_t m_rays = 0;
    size_t m_bytes = 0;
};

} // namespace vmlight
