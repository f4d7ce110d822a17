// SPDX-License-Identifier: Apache-2.0
/// Maps of a mesh that deforms: what a pose leaves as it was is not traced again.
#pragma once

#include <vmlight/vismap/make_map.h>
#include <vmlight/vismap/pose_plan.h>
#include <vmlight/vismap/pose_probe.h>
#include <vmlight/vismap/ray_bits.h>

#include <OpenImageIO/imagebuf.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vmlight {

/// How a pose was baked.
struct PoseReport
{
    std::string base; ///< name of the pose whose texels were kept; "" if it was baked whole
    std::string why; ///< it was baked whole, a phrase; "" for the first
    bool is_rigid = false; ///< everything moved as one body
    int64_t kept = 0, covered = 0; ///< texels
    PoseChange change; ///< against the base
};

/// Bakes pose after pose of one map: the same size, UDIM tile and parameters for all. The first is baked whole, and is
/// the base of those after it: each is compared with the base, never with the pose before, so that no error adds up. A
/// pose is baked whole, and is the next base, if nothing is known of more than half of the texels that trace rays.
///
/// Of a texel that is kept V stays, and B and the bands of `sh` turn with it. `mask`, `cells` and suns cannot be
/// turned: with these only texels are kept that do not turn, and with suns only what is proven.
class PoseSequence
{
public:
    /// @param error    by how much V of a kept texel may be off, in at least 99 of 100 texels (see PosePlan); 0: only
    ///                 what is proven is kept
    explicit PoseSequence(double error)
        : m_error(error)
    {
    }

    double error() const { return m_error; }

    /// Bake a pose.
    ///
    /// @param dst      as make_vismap() makes it. If texels were kept, the metadata have `vmlight:pose_base`, the name
    ///                 of the base, and `vmlight:pose_error`; else the bytes are those of make_vismap()
    /// @param name     of the pose
    /// @returns as make_vismap()
    bool bake(OIIO::ImageBuf& dst, const MapJob& job, const std::string& name, VismapReport* report);

    /// Of the last pose.
    const PoseReport& last() const { return m_last; }

private:
    bool bake_whole(OIIO::ImageBuf& dst, const MapJob& job, const std::string& name, VismapReport* report);
    // What a base was traced to be.
    struct Traced
    {
        std::vector<float> texels; // before they were reconstructed; empty if they were not
        TexelContexts contexts; // of them
        std::vector<double> errors; // Visibility::error; empty if the map does not store it
        RayBits rays; // empty if they would take too much memory
        int samples = 0;
    };
    bool bake_base(const VismapBaker& baker, const MapJob& job, BakedTexels& map, Traced& traced);

    double m_error;
    PosedMap m_base;
    std::string m_base_name;
    OIIO::ImageBuf m_map; // of the base
    Traced m_traced; // of the base; replaced only once a bake is done
    PoseReport m_last;
};

} // namespace vmlight
