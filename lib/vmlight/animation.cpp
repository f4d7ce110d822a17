// SPDX-License-Identifier: Apache-2.0
#include <vmlight/animation.h>

#include <vmlight/rotation.h>

namespace vmlight {

// The turn about y comes after the object's own rotation; both become one matrix.
LightmapParams Animation::at(const LightmapParams& params, size_t index, std::string& error) const
{
    LightmapParams frame = params, own = params;
    own.env_rotate.clear();
    Rotation rotation;
    if (!turns() || !lightmap_rotation(rotation, own, error))
        return frame;
    rotation = rotation_from_angles(0, rotate_y.at(index, frames.size()), 0) * rotation;
    frame.rotate.clear();
    frame.quaternion.clear();
    frame.matrix.assign(&rotation[0][0], &rotation[0][0] + 9);
    return frame;
}

} // namespace vmlight
