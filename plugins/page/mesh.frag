// SPDX-License-Identifier: Apache-2.0
in vec2 place;
uniform sampler2D light;
uniform float exposure_gain;
out vec4 display;

void main()
{
    vec3 linear = clamp(texture(light, place).rgb * exposure_gain, 0.0, 1.0);
    display = vec4(mix(12.92 * linear, 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, greaterThan(linear, vec3(0.0031308))),
                   1.0);
}
