// SPDX-License-Identifier: Apache-2.0
#include "strand_buffers.h"

#include <vmlight/base/format.h>
#include <vmlight/mesh/strand_curve.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

namespace vmlight::view {
namespace {

uint32_t bits_of(double share)
{
    const auto number = float(share);
    uint32_t bits = 0;
    std::memcpy(&bits, &number, sizeof(bits));
    return bits;
}

double median(std::vector<double> values)
{
    if (values.empty())
        return 0;
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

} // namespace

bool StrandBuffers::load(const StrandObject& object, const Imath::V3d& centre, std::string& error)
{
    const Strands& strands = object.strands();
    // Two more control points than points, one span less; each vertex has a number, a signed one.
    constexpr size_t kVerticesOfSpan = 4 * 6;
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
    const size_t controls = strands.points.size() + 2 * strands.count();
    if (controls > size_t(most) || strands.points.size() > size_t(INT32_MAX) / kVerticesOfSpan) {
        error = format("\"{}\": {} points of strands are too many for this graphics driver", strands.path,
                       strands.points.size());
        return false;
    }
    m_centre = centre;
    m_layout = object.layout;
    std::vector<float> places;
    std::vector<uint32_t> table;
    std::vector<double> lengths;
    places.reserve(4 * controls);
    table.reserve(4 * strands.points.size());
    for (size_t strand = 0; strand < strands.count(); ++strand) {
        const StrandCurve curve(strands, strand);
        const std::vector<double> shares = curve.knot_shares();
        for (size_t k = 0; k + 1 < shares.size(); ++k) {
            table.insert(
                table.end(),
                { uint32_t(places.size() / 4 + k), bits_of(shares[k]), bits_of(shares[k + 1]), uint32_t(strand) });
            const size_t point = strands.begin(strand) + k;
            lengths.push_back((strands.points[point + 1] - strands.points[point]).length());
        }
        for (const StrandCurve::Control& control : curve.controls()) {
            const Imath::V3f p(control.position - centre);
            places.insert(places.end(), { p.x, p.y, p.z, float(control.radius) });
        }
    }
    m_spans = GLsizei(table.size() / 4);
    m_span_length = median(std::move(lengths));
    m_control_buffer = make_buffer(GL_TEXTURE_BUFFER, places.data(), places.size() * sizeof(places[0]));
    m_controls = Texture::of_buffer(m_control_buffer, GL_RGBA32F);
    m_span_buffer = make_buffer(GL_TEXTURE_BUFFER, table.data(), table.size() * sizeof(table[0]));
    m_span_table = Texture::of_buffer(m_span_buffer, GL_RGBA32UI);
    return true;
}

} // namespace vmlight::view
