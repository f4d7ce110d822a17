// SPDX-License-Identifier: Apache-2.0
// The environment behind the object, along each pixel's ray: frame/background.h. The level is from differences of
// directions, not of texture coordinates on the screen, so that the seam of the lat-long map shows nowhere; unless EXACT
// it is the same everywhere.
uniform sampler2D environment;
uniform float rotation[9]; // object space to environment space, row major
uniform vec2 texels;
uniform int last_level;

out vec4 color;

const float kPi = 3.14159265;

vec2 position(vec3 ray)
{
    float x = rotation[0] * ray.x + rotation[1] * ray.y + rotation[2] * ray.z;
    float y = rotation[3] * ray.x + rotation[4] * ray.y + rotation[5] * ray.z;
    float z = rotation[6] * ray.x + rotation[7] * ray.y + rotation[8] * ray.z;
    return vec2(atan(-x, z) / (2.0 * kPi) + 0.5, 0.5 - atan(y, length(vec2(x, z))) / kPi);
}

float reach(vec2 change)
{
    change.x -= round(change.x); // across the seam
    return length(change * texels);
}

void main()
{
    // Rows of the framebuffer count from the bottom.
    vec2 at = (gl_FragCoord.xy + vec2(offset.x, -offset.y)) / size * 2.0 - 1.0;
    vec3 ray = is_orthographic ? forward : forward + right * (at.x * half_size.x) + up * (at.y * half_size.y);
    vec2 st = position(ray);
    float level = 0.0;
    if (!is_orthographic) {
#if EXACT
        vec3 across = right * (2.0 * half_size.x / size.x * footprint);
        vec3 down = up * (-2.0 * half_size.y / size.y * footprint);
        float texel = max(reach(position(ray + across) - st), reach(position(ray + down) - st));
#else
        // A pixel's angle over a texel's, on the equator: atan() is slow where there is no graphics card.
        float texel = 2.0 * half_size.y / size.y * footprint * texels.x / (2.0 * kPi);
#endif
        level = texel > 1.0 ? min(log2(texel), float(last_level)) : 0.0;
    }
    color = vec4(textureLod(environment, st, level).rgb, 1);
}
