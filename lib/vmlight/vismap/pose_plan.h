// SPDX-License-Identifier: Apache-2.0
/// Which texels of a map keep what they had in another pose, and which are traced again.
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/trace/pose_motion.h>
#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/pose_probe.h>

#include <cstdint>
#include <functional>
#include <vector>

namespace vmlight {

/// How much a map changes from one pose to another, from texels whose rays were traced in both.
struct PoseChange
{
    /// |dV| of at least 99 of 100 texels is no more: what 99.5 of 100 probes are within, each for the texels around it.
    double bound = 0;
    double most = 0; ///< of all probes
    double above = 0; ///< share of the texels that change by more than the error that is asked about
    int64_t probes = 0; ///< texels that were looked at; 0 where all is proven
    int64_t rays = 0; ///< in both poses
};

/// Two poses of a map, and what is known of them. All must outlive it.
struct PosePair
{
    const PosedMap &base, &pose;
    const PoseMotion& motion; ///< without fault
    const VismapBaker& baker; ///< of the pose, prepared
    const BakeHints* hints = nullptr; ///< or what is known of the rays of the base
};

class PosePlan
{
public:
    /// Whether the texels of a triangle can keep what they had; the others are neither looked at nor kept.
    using MayKeep = std::function<bool(uint32_t triangle)>;

    /// Decide on all texels. Where all is proven to move as one body, or `error` is 0, by proof. Else by probes: in
    /// each square of 8 x 8 texels one for each part of the mesh (UV island and body), and in each of 4 x 4 where one
    /// of those, or of its neighbours, changes by more than half of `error`. A texel is traced again if a probe of its
    /// part does, in its square or one beside it.
    ///
    /// @param error    by how much V of a kept texel may be off; at least 99 of 100 texels are within
    /// @returns false if `progress` stopped it
    bool decide(const PosePair& poses, double error, const MayKeep& may_keep, int nthreads, const Progress& progress);

    // After decide().
    const TileBits& kept(int tile) const { return m_kept[size_t(tile)]; }
    int64_t kept() const { return m_count; }
    int64_t covered() const { return m_covered; }
    /// Texels whose triangles trace rays; and of them those of which nothing is known: neither kept, nor of triangles
    /// that stand still.
    int64_t tracing() const { return m_tracing; }
    int64_t unknown() const { return m_unknown; }
    const PoseChange& change() const { return m_change; }

private:
    std::vector<TileBits> m_kept;
    int64_t m_count = 0, m_covered = 0, m_tracing = 0, m_unknown = 0;
    PoseChange m_change;
};

/// Look at some 4096 texels, evenly over the map (or all squares of 8 x 8, if there are fewer): how much what a map has
/// changes. False if `progress` stopped it.
bool measure_change(PoseChange& dst, const PosePair& poses, double error, int nthreads, const Progress& progress);

} // namespace vmlight
