// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/strands.h>

#include <vmlight/base/format.h>

#include <Imath/ImathBox.h>

#include <OpenImageIO/hash.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vmlight {
namespace {

bool parse_radii(double& root, double& tip, const std::string& text, std::string& error)
{
    const size_t colon = text.find(':');
    const Range allowed { 0, 1e30 };
    std::string reason;
    if (!parse_value(root, text.substr(0, colon), allowed, reason)
        || !parse_value(tip, colon == std::string::npos ? text : text.substr(colon + 1), allowed, reason)) {
        error = format("radius: \"{}\" is not ROOT:TIP, such as 0.001:0.0002, nor one number: {}", text, reason);
        return false;
    }
    if (!(std::max(root, tip) > 0)) {
        error = format("radius: \"{}\" has no thickness: root or tip must be above 0", text);
        return false;
    }
    return true;
}

// Distances along a strand from its root to each of its points.
std::vector<double> lengths_to_points(const Strands& strands, size_t strand)
{
    std::vector<double> lengths { 0 };
    for (size_t p = strands.begin(strand) + 1; p < strands.end(strand); ++p)
        lengths.push_back(lengths.back() + (strands.points[p] - strands.points[p - 1]).length());
    return lengths;
}

std::string strand_fault(const Strands& strands, size_t strand)
{
    const size_t begin = strands.begin(strand), end = strands.end(strand);
    if (end < begin + 2)
        return format("strand {} has fewer than two points", strand);
    double thickest = 0;
    for (size_t p = begin; p < end; ++p) {
        const Imath::V3d& v = strands.points[p];
        const double radius = strands.radii[p];
        if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
            return format("point {} of strand {} is not finite: ({}, {}, {})", p - begin, strand, v.x, v.y, v.z);
        if (!std::isfinite(radius) || radius < 0)
            return format("the radius at point {} of strand {} is {}", p - begin, strand, radius);
        thickest = std::max(thickest, radius);
    }
    if (!(thickest > 0))
        return format("strand {} has a radius of 0", strand);
    const double length = lengths_to_points(strands, strand).back();
    if (!(length > 0) || !std::isfinite(length))
        return format("strand {} has {} length", strand, length > 0 ? "infinite" : "no");
    return "";
}

} // namespace

bool set_radius(Strands& strands, const std::string& text, std::string& error)
{
    if (text.empty()) {
        if (!strands.radii.empty())
            return true;
        error = format("\"{}\": the file has no radius of its strands: give it by --radius ROOT:TIP, in mesh units",
                       strands.path);
        return false;
    }
    double root = 0, tip = 0;
    if (!parse_radii(root, tip, text, error))
        return false;
    strands.radii.clear();
    for (size_t s = 0; s < strands.count(); ++s) {
        const std::vector<double> lengths = lengths_to_points(strands, s);
        for (const double length : lengths)
            strands.radii.push_back(lengths.back() > 0 ? root + (tip - root) * (length / lengths.back()) : root);
    }
    return true;
}

double thickest_radius(const Strands& strands, size_t strand)
{
    return *std::max_element(strands.radii.begin() + std::ptrdiff_t(strands.begin(strand)),
                             strands.radii.begin() + std::ptrdiff_t(strands.end(strand)));
}

std::string thick_strands_warning(const Strands& strands)
{
    constexpr size_t kFewest = 100; // fewer may be ropes or posts
    constexpr double kThick = 50;
    if (strands.count() < kFewest || strands.radii.empty())
        return "";
    Imath::Box3d box;
    for (const Imath::V3d& point : strands.points)
        box.extendBy(point);
    const Imath::V3d size = box.size();
    const double extent = std::max({ size.x, size.y, size.z });
    const double thickest = *std::max_element(strands.radii.begin(), strands.radii.end());
    return thickest * kThick > extent
        ? format("strands with a radius of {:.3g} in a groom {:.3g} across hide each other and "
                 "bake slowly; are radii in mesh units?",
                 thickest, extent)
        : "";
}

bool check_strands(const Strands& strands, std::string& error)
{
    std::string reason = strands.count() == 0 ? "no strands" : "";
    if (reason.empty() && strands.radii.size() != strands.points.size())
        reason = format("{} radii for {} points", strands.radii.size(), strands.points.size());
    for (size_t s = 0; s < strands.count() && reason.empty(); ++s)
        reason = strand_fault(strands, s);
    if (!reason.empty())
        error = format("\"{}\": {}", strands.path, reason);
    return reason.empty();
}

std::string strands_hash(const Strands& strands)
{
    const auto fingerprint = [](const auto& elements) {
        const char* bytes = reinterpret_cast<const char*>(elements.data());
        return OIIO::farmhash::Fingerprint64(bytes, elements.size() * sizeof(elements[0]));
    };
    const std::array<uint64_t, 3> parts { fingerprint(strands.points), fingerprint(strands.radii),
                                          fingerprint(strands.ends) };
    const uint64_t hash = fingerprint(parts);
    return format("{:016x}", hash);
}

} // namespace vmlight
