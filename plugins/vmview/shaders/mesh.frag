// SPDX-License-Identifier: Apache-2.0
// The surface, with the lookup of frame/texture_pyramid.h. find_point() comes before it, and what is the same for all
// of a draw: SHOW (0: lit; 1: checker; 2: texel density; 3: the texture as it is) and MATERIAL (0: white; 1: a colour;
// 2: a texture). Software renderers compute both sides of every branch.
uniform sampler2D lit;
uniform vec2 texels; // of its level 0
uniform int last_level;
uniform float density_scale; // texels per unit that are shown as middle grey

uniform vec4 material_color;
uniform sampler2D material_texture;
uniform vec2 material_texels;
uniform int material_last_level;
uniform mat3 material_transform;
uniform int alpha_mode; // 0: opaque; 1: mask; 2: blend
uniform float alpha_cutoff;

out vec4 color; // times alpha

float level_of(vec2 across, vec2 down, vec2 texels, int last_level)
{
    float reach = max(length(across * texels), length(down * texels));
    return min(reach > 1.0 ? log2(reach) : 0.0, float(last_level));
}

vec3 look_up(Point point)
{
    float lambda = level_of(point.st_across, point.st_down, texels, last_level);
    vec4 sum = textureLod(lit, point.st, lambda);
    for (int level = int(lambda) + 1; !(sum.a > 0.0) && level <= last_level; ++level)
        sum = textureLod(lit, point.st, float(level));
    return sum.a > 0.0 ? sum.rgb / sum.a : vec3(0);
}

// frame/surface_color.h: colour, and opacity.
vec4 surface_of_material(Point point)
{
#if MATERIAL == 0
    return vec4(1);
#else
    vec4 surface = material_color;
#if MATERIAL == 2
    vec3 st = material_transform * vec3(point.uv, 1);
    st.y = 1.0 - st.y;
    mat2 turn = mat2(material_transform);
    float level = level_of(turn * point.uv_across, turn * point.uv_down, material_texels, material_last_level);
    if (!isnan(st.x + st.y))
        surface *= textureLod(material_texture, st.xy, level);
#endif
    if (alpha_mode == 0)
        surface.a = 1.0;
    else if (alpha_mode == 1)
        surface.a = surface.a >= alpha_cutoff ? 1.0 : 0.0;
    return vec4(surface.rgb, clamp(surface.a, 0.0, 1.0));
#endif
}

// Dark red for few texels, over green, to light blue for many; a factor of 16 from end to end.
vec3 heat(float x)
{
    return clamp(vec3(1.5 - abs(4.0 * x - 1.0), 1.5 - abs(4.0 * x - 2.0), 1.5 - abs(4.0 * x - 3.0)), 0.0, 1.0);
}

void main()
{
    Point point;
    bool is_inside = find_point(point);
    vec4 surface = surface_of_material(point);
    if (!is_inside || !(surface.a > 0.0))
        discard;
#if SHOW == 1
    ivec2 cell = ivec2(floor(point.st * 16.0));
    vec3 rgb = vec3((cell.x + cell.y) % 2 == 0 ? 0.7 : 0.25) * vec3(0.5 + 0.5 * point.st, 1.0);
#elif SHOW == 2
    float density = point.density * sqrt(texels.x * texels.y);
    vec3 rgb = heat(clamp(0.5 + log2(density / density_scale) / 4.0, 0.0, 1.0));
#elif SHOW == 0
    vec3 rgb = look_up(point) * surface.rgb;
#else
    vec3 rgb = look_up(point);
#endif
    // What has no UVs, or UVs in another UDIM tile, is black. Written so that NaN is outside.
    vec2 uv = vec2(point.st.x, 1.0 - point.st.y);
    if (!(all(greaterThanEqual(uv, vec2(0))) && all(lessThanEqual(uv, vec2(1.0 + 1e-6)))))
        rgb = vec3(0);
    color = vec4(rgb * surface.a, surface.a);
}
