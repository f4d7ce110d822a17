// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/curves.h>

#include <vmlight/base/available_memory.h>
#include <vmlight/base/format.h>
#include <vmlight/mesh/strand_curve.h>

namespace vmlight {
namespace {

// Embree's round curves keep their width up to about 6000 radii a span; flat ones always.
constexpr double kLongestSpan = 2000;
constexpr size_t kMostSpans = 65536;

} // namespace

bool Curves::add(const Strands& strands, const SceneFrame& frame, CurveShape shape, uint32_t first_owner,
                 std::string& error)
{
    const double available = double(available_memory()); // reads files of the system
    m_controls.reserve(m_controls.size() + strands.points.size() + 2 * strands.count());
    m_spans.reserve(m_spans.size() + strands.points.size());
    m_strand_of.reserve(m_spans.capacity());
    for (size_t strand = 0; strand < strands.count(); ++strand) {
        StrandCurve curve(strands, strand);
        if (shape == CurveShape::round && !curve.cut(kLongestSpan, kMostSpans)) {
            error = format("\"{}\": strand {} is more than {} times as long as it is thick: rays would miss it",
                           strands.path, strand, int64_t(kLongestSpan) * int64_t(kMostSpans));
            return false;
        }
        const auto& controls = curve.controls();
        for (size_t k = 0; k + 3 < controls.size(); ++k) {
            m_spans.push_back(uint32_t(m_controls.size() + k));
            m_strand_of.push_back(first_owner == kNoOwner ? kNoOwner : uint32_t(first_owner + strand));
        }
        for (const StrandCurve::Control& control : controls) {
            const Imath::V3f p = frame.to_scene(control.position);
            m_controls.push_back({ p.x, p.y, p.z, float(control.radius * frame.scale) });
        }
        const double bytes = kBytesOfSpan * double(m_spans.size());
        if (m_controls.size() <= UINT32_MAX && bytes < available)
            continue;
        error = format("\"{}\": out of memory: up to strand {} alone, curves need {:.3g} GB", strands.path, strand,
                       bytes * 1e-9);
        return false;
    }
    return true;
}

} // namespace vmlight
