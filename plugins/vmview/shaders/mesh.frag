// SPDX-License-Identifier: Apache-2.0
// The surface, with the lookup of frame/texture_pyramid.h.
in vec3 seen;
in vec2 texture_st;
in vec3 surface_normal;

uniform sampler2D lit;
uniform vec2 texels; // of its level 0
uniform int last_level;
uniform int show; // 0: lit; 1: checker; 2: texel density
uniform float density_scale; // texels per unit that are shown as middle grey

out vec4 color;

// How st changes from pixel to pixel: exactly, along the triangle's plane, not as differences, which miss perspective.
void find_footprint(out vec2 across, out vec2 down)
{
    vec3 px = dFdx(seen), py = dFdy(seen);
    vec2 sx = dFdx(texture_st), sy = dFdy(texture_st);
    vec3 n = cross(px, py);
    float n2 = dot(n, n);
    if (!(n2 > 0.0)) {
        across = sx * footprint;
        down = -sy * footprint;
        return;
    }
    vec3 ray = is_orthographic ? vec3(0, 0, 1) : seen / seen.z;
    float facing = dot(n, ray), distance = is_orthographic ? 1.0 : seen.z;
    vec3 step_x = vec3(2.0 * half_size.x / size.x * distance * footprint, 0, 0);
    vec3 step_y = vec3(0, -2.0 * half_size.y / size.y * distance * footprint, 0);
    step_x -= ray * (dot(n, step_x) / facing);
    step_y -= ray * (dot(n, step_y) / facing);
    // In terms of px and py, which span the plane.
    across = sx * (dot(cross(step_x, py), n) / n2) + sy * (dot(cross(px, step_x), n) / n2);
    down = sx * (dot(cross(step_y, py), n) / n2) + sy * (dot(cross(px, step_y), n) / n2);
}

vec3 look_up(vec2 across, vec2 down)
{
    float reach = max(length(across * texels), length(down * texels));
    float lambda = min(reach > 1.0 ? log2(reach) : 0.0, float(last_level));
    vec4 sum = textureLod(lit, texture_st, lambda);
    for (int level = int(lambda) + 1; !(sum.a > 0.0) && level <= last_level; ++level)
        sum = textureLod(lit, texture_st, float(level));
    return sum.a > 0.0 ? sum.rgb / sum.a : vec3(0);
}

// Dark red for few texels, over green, to light blue for many; a factor of 16 from end to end.
vec3 heat(float x)
{
    return clamp(vec3(1.5 - abs(4.0 * x - 1.0), 1.5 - abs(4.0 * x - 2.0), 1.5 - abs(4.0 * x - 3.0)), 0.0, 1.0);
}

void main()
{
    vec2 across, down;
    find_footprint(across, down);
    vec3 rgb = vec3(0);
    if (isnan(texture_st.x) || isnan(texture_st.y))
        rgb = vec3(0);
    else if (show == 1) {
        ivec2 cell = ivec2(floor(texture_st * 16.0));
        rgb = vec3((cell.x + cell.y) % 2 == 0 ? 0.7 : 0.25) * vec3(0.5 + 0.5 * texture_st, 1.0);
    } else if (show == 2) {
        float area = length(cross(dFdx(seen), dFdy(seen)));
        float covered = abs(dFdx(texture_st).x * dFdy(texture_st).y - dFdx(texture_st).y * dFdy(texture_st).x);
        float density = sqrt(covered * texels.x * texels.y / max(area, 1e-30));
        rgb = heat(clamp(0.5 + log2(density / density_scale) / 4.0, 0.0, 1.0));
    } else
        rgb = look_up(across, down);
    color = vec4(rgb, 1);
}
