// SPDX-License-Identifier: Apache-2.0
#include "view.h"

#include <algorithm>

namespace vmlight::view {
namespace {

void set_vector(const Program& program, const char* name, const Imath::V3d& v)
{
    program.set(name, float(v.x), float(v.y), float(v.z));
}

} // namespace

void set_view(const Program& program, const View& view, const Imath::V3d& centre)
{
    set_vector(program, "eye", view.camera.position - centre);
    set_vector(program, "right", view.camera.right);
    set_vector(program, "up", view.camera.up);
    set_vector(program, "forward", view.camera.forward);
    program.set("half_size", float(view.camera.half_width), float(view.camera.half_height));
    program.set("is_orthographic", int(view.camera.is_orthographic));
    program.set("size", float(view.width), float(view.height));
    program.set("offset", float(view.offset.x), float(view.offset.y));
    program.set("footprint", float(view.footprint));
}

Imath::V2d depth_range_of(const Camera& camera, const Subject& subject)
{
    const double distance = (subject.centre() - camera.position).dot(camera.forward), radius = subject.radius();
    const double nearest = distance - 1.001 * radius;
    const double least = camera.is_orthographic ? nearest : std::max(nearest, 1e-4 * radius);
    return { least, std::max(distance + 1.001 * radius, least + 1e-4 * radius) };
}

} // namespace vmlight::view
