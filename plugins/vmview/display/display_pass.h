// SPDX-License-Identifier: Apache-2.0
/// The last pass: OpenColorIO's own shader, once over the viewport.
#pragma once

#include "../gl/objects.h"
#include "../gl/program.h"

#include <OpenColorIO/OpenColorIO.h>

#include <string>
#include <vector>

namespace vmlight::view {

class DisplayPass
{
public:
    /// Take OpenColorIO's shader for `processor`, with all its lookup tables, of any number and size. False, with the
    /// reason in `error`, if it cannot be had or compiled; the pass then is as before.
    bool build(const OCIO_NAMESPACE::ConstProcessorRcPtr& processor, std::string& error);

    /// Draw `scene`, scene-linear, times `gain`, over the viewport of `width` x `height` pixels, clamped to [0, 1].
    void run(const Texture& scene, float gain, int width, int height) const;

private:
    struct Table
    {
        Texture texture;
        std::string sampler;
    };
    bool load_tables(std::vector<Table>& dst, std::string& error) const;
    void set_uniforms() const;

    OCIO_NAMESPACE::GpuShaderDescRcPtr m_description;
    Program m_program;
    std::vector<Table> m_tables;
};

} // namespace vmlight::view
