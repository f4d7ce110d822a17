// SPDX-License-Identifier: Apache-2.0
// Scene-linear light to a display; OpenColorIO's own code, which defines to_display(), comes before it.
uniform sampler2D scene; // R, G, B over black, and alpha
uniform float exposure_gain;
uniform vec2 scene_scale; // of this viewport's pixels to those of `scene`

out vec4 display;

void main()
{
    vec4 light = texture(scene, gl_FragCoord.xy * scene_scale);
    vec4 seen = to_display(vec4(light.rgb * exposure_gain, light.a));
    // Views may leave [0, 1] far behind, and framebuffers of floats keep what they get.
    display = vec4(clamp(seen.rgb, 0.0, 1.0), light.a);
}
