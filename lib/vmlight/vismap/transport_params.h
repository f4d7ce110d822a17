// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/base/params.h>

#include <cstddef>
#include <limits>

namespace vmlight {

struct TransportParams
{
    /// What LightTransport can count.
    static constexpr Range kRays { 8, 248 };

    /// Rays per texel.
    int rays = 64;
    /// Whether the ground sends light back; it is black otherwise.
    bool ground = false;
    /// Keep what rays met, so that new light needs none, if that takes no more bytes; else they are traced each time.
    size_t most_bytes = size_t(1) << 30;
    /// Fail rather than take more bytes than these, or than are available.
    size_t memory = std::numeric_limits<size_t>::max();

    template <class Visit> void visit(Visit&& field) { field("rays", rays, kRays, "Rays per texel"); }
};

} // namespace vmlight
