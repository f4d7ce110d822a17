// SPDX-License-Identifier: Apache-2.0
// The lookup along a direction, step by step as lightmap/lookup_kernel.h and model_paper.cpp do it; `precise` keeps the
// compiler from merging or reordering operations, so that only division and square root may round differently.
// Lat-long maps come with their frame (lightmap/cfem_lookup.h): four fetches need no test for seam or poles.

uniform sampler2DArray map; // layer 0: V, B; 1: normal or tangent, coverage; from 2 on: harmonics
uniform float rotation[9]; // object space to environment space, row major
uniform float gain;
uniform ivec2 light_size; // without the frame
uniform sampler2D added; // light besides that of the model, if it has_added
uniform bool has_added;

out vec4 lit; // R, G, B times coverage, and coverage

const float kSmallest = 1.17549435e-38;
const float kAtanTurns[8] = float[8](0.159154832, -0.0530461222, 0.0317459442, -0.022136271, 0.0153460335,
                                     -0.00889872294, 0.00347959786, -0.000645304448);

float atan2_turns(float y, float x)
{
    float ax = abs(x), ay = abs(y);
    precise float a = min(ax, ay) / max(max(ax, ay), kSmallest);
    precise float s = a * a;
    precise float r = kAtanTurns[7];
    for (int i = 6; i >= 0; --i)
        r = r * s + kAtanTurns[i];
    r = r * a;
    r = ay > ax ? 0.25 - r : r;
    r = x < 0.0 ? 0.5 - r : r;
    return floatBitsToInt(y) < 0 ? -r : r;
}

struct Lookup
{
    ivec2 texel; // of the frame, upper left of four
    vec4 weights; // upper left, upper right, lower left, lower right
    float largest; // component of the direction
    float length; // of the direction
};

// `total` is what the weights sum to.
Lookup look(vec3 b, float total)
{
    Lookup found;
    precise float m = max(max(abs(b.x), abs(b.y)), abs(b.z));
    precise float scale = 1.0 / max(m, kSmallest);
    precise float x = b.x * scale, y = b.y * scale, z = b.z * scale;
    precise float squares = x * x + y * y + z * z;
    precise float ex = rotation[0] * x + rotation[1] * y + rotation[2] * z;
    precise float ey = rotation[3] * x + rotation[4] * y + rotation[5] * z;
    precise float ez = rotation[6] * x + rotation[7] * y + rotation[8] * z;
    precise float across_squared = ex * ex + ez * ez;
    float across = sqrt(across_squared);

    float w = float(light_size.x), h = float(light_size.y);
    precise float u = 0.5 * w + 0.5 - atan2_turns(ex, ez) * w;
    precise float t = 0.5 * h + 0.5 - atan2_turns(ey, across) * (2.0 * h);
    // Written so that NaN, too, ends inside.
    u = u > 0.0 ? min(u, w + 0.5) : 0.0;
    t = t > 0.5 ? min(t, h + 0.5) : 0.5;
    found.texel = ivec2(int(u), int(t));
    precise float fu = u - float(found.texel.x), ft = t - float(found.texel.y);

    precise float lower = total * ft, upper = total - lower;
    precise float w01 = upper * fu, w00 = upper - w01, w11 = lower * fu, w10 = lower - w11;
    found.weights = vec4(w00, w01, w10, w11);
    found.largest = m;
    found.length = m * sqrt(squares);
    return found;
}

vec3 bilinear(Lookup at, vec3 p0, vec3 p1, vec3 q0, vec3 q1)
{
    precise vec3 sum = (at.weights.x * p0 + at.weights.y * p1) + (at.weights.z * q0 + at.weights.w * q1);
    return sum;
}

void put(vec3 rgb)
{
    float coverage = texelFetch(map, ivec3(ivec2(gl_FragCoord.xy), 1), 0).w;
    precise vec3 sum = rgb;
    if (has_added)
        sum = sum + gain * texelFetch(added, ivec2(gl_FragCoord.xy), 0).rgb;
    lit = vec4(sum * coverage, coverage);
}
