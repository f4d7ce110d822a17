// SPDX-License-Identifier: Apache-2.0
/// What a frame shows: meshes, what their surfaces are looked up in, and what is behind them.
#pragma once

#include <vmlight/frame/background.h>
#include <vmlight/frame/strand_specular.h>
#include <vmlight/frame/strand_surface.h>
#include <vmlight/frame/surface_texture.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/trace/visible_surface.h>

#include <Imath/ImathColor.h>

#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// The colour of one material, in the space of the light.
struct SurfaceMaterial
{
    Imath::C3f color { 1, 1, 1 };
    float alpha = 1;
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5f;
    /// nullptr or four channels, R G B A: multiplied.
    std::shared_ptr<const TexturePyramid> texture;
    Imath::M33d uv_transform;
    int uv_set = 0;
    /// nullptr or one channel, which multiplies alpha.
    std::shared_ptr<const TexturePyramid> opacity;
    Imath::M33d opacity_transform;
    int opacity_uv_set = 0;
};

struct FrameSurface
{
    std::shared_ptr<const Mesh> mesh;
    /// Where the strands of `mesh` are in their map, and their colour; nullptr: it has triangles.
    std::shared_ptr<const StrandSurface> strands;
    Imath::C3f strand_color { 1, 1, 1 };
    /// nullptr or the highlights of strands, at the rotation of `light`; times V of `visibility`.
    std::shared_ptr<const StrandSpecular> specular;
    /// Three channels: the light that a white surface would send out, by the mesh's uvs.
    std::shared_ptr<const SurfaceTexture> light;
    /// nullptr or four channels: V and B.
    std::shared_ptr<const SurfaceTexture> visibility;
    /// For each of the mesh's materials; empty: white.
    std::vector<SurfaceMaterial> materials;
    /// For each UV set that materials ask for, three uvs a triangle. Sets that are not there are those of the mesh.
    std::vector<std::vector<Imath::V2f>> material_uvs;
    /// Multiplied to what materials have.
    double opacity = 1;
    /// Opacity falls to 0 from `fade_start` to `fade_end` away from `fade_centre`: of the ground. 0: does not.
    Imath::V3d fade_centre { 0 };
    double fade_start = 0, fade_end = 0;
    /// Only its shadow is seen: black, as opaque as light is missing from `unshadowed`.
    bool catches_shadows = false;
    float unshadowed = 1;
};

struct FrameScene
{
    std::vector<FrameSurface> surfaces;
    std::shared_ptr<const VisibleSurface> tracer;
    Background background;
    /// The middle and half the diagonal of all that can be seen.
    Imath::V3d centre { 0 };
    double radius = 1;

    /// Build `tracer`, `centre` and `radius` from the surfaces. False, with the reason in `error`, if memory runs out.
    bool build(int nthreads, std::string& error);
};

} // namespace vmlight
