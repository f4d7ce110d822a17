// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/cfem.h>
#include <vmlight/color.h>
#include <vmlight/stage_main.h>

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight {

/// What makelightmap reads, once for all frames: the visibility map, the CFEM (filtered here, if an environment is
/// given) and the albedo.
class LightInput
{
public:
    void declare(StageMain& stage);
    bool read(StageMain& stage, std::string& error);

    OIIO::ImageBuf vismap, cfem;
    const OIIO::ImageBuf* albedo() const { return m_albedo_path.empty() ? nullptr : &m_albedo; }

private:
    bool filter(StageMain& stage, std::string& error);

    OIIO::ImageBuf m_albedo;
    std::string m_albedo_path, m_albedo_space;
    CfemParams m_filter;
    ColorSettings m_color;
    bool m_is_cfem = false;
};

} // namespace vmlight
