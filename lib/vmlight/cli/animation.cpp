// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/animation.h>

#include <vmlight/base/format.h>
#include <vmlight/math/rotation.h>

namespace vmlight {

std::string Animation::fault(const std::string& output) const
{
    if (frames.size() > 1 && output.find('#') == std::string::npos)
        return format("\"{}\": {} frames need #### in the file name, for the number", output, frames.size());
    return has_frames || rotate_y.first == rotate_y.last
        ? ""
        : format("rotate_y: {} to {} degrees needs --frames", rotate_y.first, rotate_y.last);
}

std::string Animation::path(const std::string& output, size_t index) const
{
    return has_frames ? frame_path(output, frames[index]) : output;
}

LightmapParams Animation::params_at(const LightmapParams& params, size_t index, std::string& error) const
{
    LightmapParams frame = params, own = params;
    own.env_rotate.clear();
    Rotation rotation;
    if (!rotates() || !lightmap_rotation(rotation, own, error))
        return frame;
    rotation = rotation_from_angles(0, rotate_y.at(index, frames.size()), 0) * rotation;
    frame.rotate.clear();
    frame.quaternion.clear();
    frame.matrix.assign(&rotation[0][0], &rotation[0][0] + 9);
    return frame;
}

} // namespace vmlight
