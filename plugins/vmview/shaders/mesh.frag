// SPDX-License-Identifier: Apache-2.0
// The surface, with the lookup of frame/texture_pyramid.h.
in vec3 seen;
in vec2 texture_st;
in vec2 material_uv;

uniform sampler2D lit;
uniform vec2 texels; // of its level 0
uniform int last_level;
uniform int show; // 0: lit; 1: checker; 2: texel density; 3: the texture as it is
uniform float density_scale; // texels per unit that are shown as middle grey

uniform vec4 material_color;
uniform bool has_material_texture;
uniform sampler2D material_texture;
uniform vec2 material_texels;
uniform int material_last_level;
uniform mat3 material_transform;
uniform int alpha_mode; // 0: opaque; 1: mask; 2: blend
uniform float alpha_cutoff;

out vec4 color; // times alpha

// How an attribute changes from pixel to pixel, from its differences dx and dy on the screen: exactly, along the
// triangle's plane, since differences miss perspective.
struct Steps
{
    vec2 across, down; // what the two steps are in dx and dy
};

Steps find_steps()
{
    vec3 px = dFdx(seen), py = dFdy(seen), n = cross(px, py);
    float n2 = dot(n, n);
    if (!(n2 > 0.0))
        return Steps(vec2(footprint, 0), vec2(0, -footprint));
    vec3 ray = is_orthographic ? vec3(0, 0, 1) : seen / seen.z;
    float facing = dot(n, ray), distance = is_orthographic ? 1.0 : seen.z;
    vec3 step_x = vec3(2.0 * half_size.x / size.x * distance * footprint, 0, 0);
    vec3 step_y = vec3(0, -2.0 * half_size.y / size.y * distance * footprint, 0);
    step_x -= ray * (dot(n, step_x) / facing);
    step_y -= ray * (dot(n, step_y) / facing);
    return Steps(vec2(dot(cross(step_x, py), n), dot(cross(px, step_x), n)) / n2,
                 vec2(dot(cross(step_y, py), n), dot(cross(px, step_y), n)) / n2);
}

float level_of(vec2 dx, vec2 dy, Steps steps, vec2 texels, int last_level)
{
    vec2 across = dx * steps.across.x + dy * steps.across.y, down = dx * steps.down.x + dy * steps.down.y;
    float reach = max(length(across * texels), length(down * texels));
    return min(reach > 1.0 ? log2(reach) : 0.0, float(last_level));
}

vec3 look_up(Steps steps)
{
    float lambda = level_of(dFdx(texture_st), dFdy(texture_st), steps, texels, last_level);
    vec4 sum = textureLod(lit, texture_st, lambda);
    for (int level = int(lambda) + 1; !(sum.a > 0.0) && level <= last_level; ++level)
        sum = textureLod(lit, texture_st, float(level));
    return sum.a > 0.0 ? sum.rgb / sum.a : vec3(0);
}

// frame/surface_color.h: colour, and opacity.
vec4 surface_of_material(Steps steps)
{
    vec4 surface = material_color;
    if (has_material_texture) {
        vec3 st = material_transform * vec3(material_uv, 1);
        st.y = 1.0 - st.y;
        mat2 turn = mat2(material_transform);
        vec2 dx = turn * dFdx(material_uv), dy = turn * dFdy(material_uv);
        float level = level_of(dx, dy, steps, material_texels, material_last_level);
        if (!isnan(st.x + st.y))
            surface *= textureLod(material_texture, st.xy, level);
    }
    if (alpha_mode == 0)
        surface.a = 1.0;
    else if (alpha_mode == 1)
        surface.a = surface.a >= alpha_cutoff ? 1.0 : 0.0;
    return vec4(surface.rgb, clamp(surface.a, 0.0, 1.0));
}

// Dark red for few texels, over green, to light blue for many; a factor of 16 from end to end.
vec3 heat(float x)
{
    return clamp(vec3(1.5 - abs(4.0 * x - 1.0), 1.5 - abs(4.0 * x - 2.0), 1.5 - abs(4.0 * x - 3.0)), 0.0, 1.0);
}

void main()
{
    Steps steps = find_steps();
    vec4 surface = surface_of_material(steps);
    if (!(surface.a > 0.0))
        discard;
    vec3 rgb = vec3(0);
    if (show == 1) {
        ivec2 cell = ivec2(floor(texture_st * 16.0));
        rgb = vec3((cell.x + cell.y) % 2 == 0 ? 0.7 : 0.25) * vec3(0.5 + 0.5 * texture_st, 1.0);
    } else if (show == 2) {
        float area = length(cross(dFdx(seen), dFdy(seen)));
        float covered = abs(dFdx(texture_st).x * dFdy(texture_st).y - dFdx(texture_st).y * dFdy(texture_st).x);
        float density = sqrt(covered * texels.x * texels.y / max(area, 1e-30));
        rgb = heat(clamp(0.5 + log2(density / density_scale) / 4.0, 0.0, 1.0));
    } else if (show == 0) {
        rgb = look_up(steps) * surface.rgb;
    } else {
        rgb = look_up(steps);
    }
    // What has no UVs, or UVs in another UDIM tile, is black. Written so that NaN is outside.
    vec2 uv = vec2(texture_st.x, 1.0 - texture_st.y);
    if (!(all(greaterThanEqual(uv, vec2(0))) && all(lessThanEqual(uv, vec2(1.0 + 1e-6)))))
        rgb = vec3(0);
    color = vec4(rgb * surface.a, surface.a);
}
