// SPDX-License-Identifier: Apache-2.0
/// Strands of hair, fur or grass: polylines with a radius.
#pragma once

#include <vmlight/base/params.h>

#include <Imath/ImathVec.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vmlight {

/// Strands in y-up object space. A strand is known by its place in the file, from 0.
struct Strands
{
    /// File name without its folder; and as it was given, for messages.
    std::string name, path;
    /// Strand after strand, each from root to tip.
    std::vector<Imath::V3d> points;
    /// Of each point, in mesh units; empty if the file has none.
    std::vector<double> radii;
    /// Of each strand: one past its last point.
    std::vector<uint32_t> ends;

    size_t count() const { return ends.size(); }
    size_t begin(size_t strand) const { return strand ? ends[strand - 1] : 0; }
    size_t end(size_t strand) const { return ends[strand]; }
};

/// How thick strands are, and how finely they are baked.
struct StrandParams
{
    /// "ROOT:TIP", in mesh units, linear along each strand; one number for both. "" is the file's own.
    std::string radius;
    /// Texels along each strand.
    int strand_texels = 16;

    template <class Visit> void visit(Visit&& field)
    {
        field(
            "radius", radius, Text { "ROOT[:TIP]" },
            "Bake the file's strands, or let an occluder's block light, of this radius in mesh units: ROOT:TIP, or one "
            "for both");
        field("strand_texels", strand_texels, Range { 1, 4096 }, "Texels along each strand, from root to tip");
    }
};

/// The largest radius of a strand.
double thickest_radius(const Strands& strands, size_t strand);

/// A radius below this share of a strand's largest is raised to it: rays miss curves that end in a point.
constexpr double kThinnestTip = 0.02;

/// Give all points the radius `text`, see StrandParams::radius; "" keeps what the file has.
/// @returns false, with the reason in `error`, if it is not one or two numbers, one of them is negative or not finite,
///          both are 0, or the file has no radius and the text is empty.
bool set_radius(Strands& strands, const std::string& text, std::string& error);

/// Can the strands be baked? False, with the reason in `error`, if there are none, one has fewer than two points or no
/// length, a point or a radius is not finite (the first is named), a radius is negative, or all of a strand's are 0.
bool check_strands(const Strands& strands, std::string& error);

/// A warning, without the name, of a hundred or more strands some of which are thicker than hair or grass can be: their
/// radius is more than a fiftieth of the longest side of the box around all; or "".
std::string thick_strands_warning(const Strands& strands);

/// A 64-bit hash of points, radii and ends, as 16 hexadecimal digits. The same on every little-endian machine.
std::string strands_hash(const Strands& strands);

} // namespace vmlight
