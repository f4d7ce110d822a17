// SPDX-License-Identifier: Apache-2.0
/// Strands on the graphics card: the spans of their curves, which strand.vert makes ribbons of.
#pragma once

#include "../gl/objects.h"

#include <vmlight/frame/strand_object.h>

#include <string>

namespace vmlight::view {

class StrandBuffers
{
public:
    /// Load the curves of `object`. False, with the reason in `error`, if the driver has no room for them.
    ///
    /// @param centre   near the strands: positions are kept in float relative to it
    bool load(const StrandObject& object, const Imath::V3d& centre, std::string& error);

    const Imath::V3d& centre() const { return m_centre; }
    const StrandLayout& layout() const { return m_layout; }
    GLsizei spans() const { return m_spans; }
    /// The middle of their lengths, in mesh units.
    double span_length() const { return m_span_length; }
    /// Control points of B-splines: x, y, z, radius.
    const Texture& controls() const { return m_controls; }
    /// Of each span: its first control point, the shares of the strand's length at its ends (the bits of two floats),
    /// and its strand.
    const Texture& span_table() const { return m_span_table; }

private:
    Imath::V3d m_centre { 0 };
    StrandLayout m_layout;
    GLsizei m_spans = 0;
    double m_span_length = 0;
    Buffer m_control_buffer, m_span_buffer;
    Texture m_controls, m_span_table;
};

} // namespace vmlight::view
