// SPDX-License-Identifier: Apache-2.0
// The point of the surface that a fragment shows, as OpenGL's rasterizer finds it: quick.
in vec3 seen;
in vec2 texture_st;
in vec2 material_uv;

// How an attribute changes from pixel to pixel, from its differences dx and dy on the screen: exactly, along the
// triangle's plane, since differences miss perspective.
bool find_point(out Point point)
{
    point.st = texture_st;
    point.uv = material_uv;
    vec3 px = dFdx(seen), py = dFdy(seen), n = cross(px, py);
    vec2 sx = dFdx(texture_st), sy = dFdy(texture_st), ux = dFdx(material_uv), uy = dFdy(material_uv);
    float n2 = dot(n, n);
    point.density = sqrt(abs(sx.x * sy.y - sx.y * sy.x) / max(sqrt(n2), 1e-30));
    vec2 across = vec2(footprint, 0), down = vec2(0, -footprint);
    if (n2 > 0.0) {
        vec3 ray = is_orthographic ? vec3(0, 0, 1) : seen / seen.z;
        float facing = dot(n, ray), distance = is_orthographic ? 1.0 : seen.z;
        vec3 step_x = vec3(2.0 * half_size.x / size.x * distance * footprint, 0, 0);
        vec3 step_y = vec3(0, -2.0 * half_size.y / size.y * distance * footprint, 0);
        step_x -= ray * (dot(n, step_x) / facing);
        step_y -= ray * (dot(n, step_y) / facing);
        across = vec2(dot(cross(step_x, py), n), dot(cross(px, step_x), n)) / n2;
        down = vec2(dot(cross(step_y, py), n), dot(cross(px, step_y), n)) / n2;
    }
    point.st_across = sx * across.x + sy * across.y;
    point.st_down = sx * down.x + sy * down.y;
    point.uv_across = ux * across.x + uy * across.y;
    point.uv_down = ux * down.x + uy * down.y;
    return true;
}
