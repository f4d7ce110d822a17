// SPDX-License-Identifier: Apache-2.0
/// What a visibility map stores of suns: its channels `sun.N`.
#pragma once

#include <vmlight/cfem/suns.h>
#include <vmlight/math/rotation.h>

#include <OpenImageIO/imageio.h>

#include <vector>

namespace vmlight {

/// The discs, in object space, of which a visibility map stores what texels see; and the indices of their channels.
struct StoredSuns
{
    std::vector<Disc> discs;
    std::vector<int> channels;

    bool empty() const { return discs.empty(); }
    /// The channels of `wanted`, in their order: of discs within a quarter of a degree of them, and about as wide (a
    /// quarter of a degree, or a quarter of the half angle). Empty if one is not among them, or none is wanted.
    std::vector<int> channels_of(const std::vector<Disc>& wanted) const;
};

/// By the header of a visibility map. Empty if it has no `vmlight:sun_directions`, or lacks one of their channels.
StoredSuns stored_suns(const OIIO::ImageSpec& vismap);

/// The discs of suns, turned to object space; `rotation` is that from object space to the environment's.
std::vector<Disc> discs_in_object_space(const std::vector<Sun>& suns, const Rotation& rotation);

} // namespace vmlight
