// SPDX-License-Identifier: Apache-2.0
/// Visibility maps: how much of its hemisphere each texel of a mesh sees, and which way on average.
/// Source: I. Neulander, "Image-Based Diffuse Lighting Using Visibility Maps", section 2.
#pragma once

#include <vmlight/base/export.h>
#include <vmlight/base/params.h>
#include <vmlight/base/progress.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/uv/report.h>
#include <vmlight/uv/udim.h>

#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight {

/// The words that VismapParams::basis takes.
VMLIGHT_API Choices basis_choices();

struct VismapParams
{
    /// One number is a square map; width and height, if not 0, replace its sides.
    Size resolution { 1024, 1024 };
    int width = 0, height = 0;
    /// The part of uv space that is baked: 1001 + u + 10 v for the square with its lower left corner at (u, v).
    int udim = kFirstUdim;
    Size size() const { return { width ? width : resolution.width, height ? height : resolution.height }; }
    /// Measured on six scenes: at 64 rays the paper's model is within 2.2 % of the shading error it has at 4096 rays, a
    /// model that also uses |B| is within 2 % at 128.
    int samples = 128;
    /// The most that VismapReport::error may be: the samples are then those that some texels, baked twice, say it
    /// takes, and `samples` says nothing. 0 is none. Where nothing is occluded, one ray is enough.
    double target_error = 0;
    /// `fibonacci` has the least error at a fixed number of rays (README, "What it costs"); `halton` is the paper's.
    std::string sampler = "fibonacci";
    /// Same seed, same pixels, for any number of threads.
    int seed = 0;
    /// `cosine`: V and B as in make_vismap(). `uniform`: V is the share of the hemisphere's solid angle that is seen,
    /// B has the direction of the cosine-weighted mean: the paper's literal words.
    std::string measure = "cosine";
    /// Ignore what is farther than this, in the mesh's units; 0 is no limit.
    double max_distance = 0;
    /// Texels around what the mesh covers that are filled from it; -1 is all.
    int margin = 16;
    /// What to store beside V and B. `normal`: channels `normal.x`, `normal.y`, `normal.z`, the interpolated normal in
    /// object space, of unit length; in the margin a mean of neighbours, as B is, and so shorter: what uses it must not
    /// rely on its length. `coverage`: a channel that is 1 where a triangle covers the texel's centre.
    /// `error`: a channel with the standard error of V, from how the rays of each texel scatter, all scaled by one
    /// factor so that its root mean square is VismapReport::error. It tells where the error is large better than how
    /// large: below 16 rays of a texel little more than whether they agree. 0, where all agree, is no proof: the next
    /// ray may not. In the margin a mean of neighbours, as V is. It takes 2 rays to scatter.
    std::vector<std::string> channels;
    /// What more to store, for models that know more than V and B tell (README, "What accuracy costs"): `vector` is
    /// nothing; `sh` the spherical harmonics of (1/pi) vis(w) max(0, n.w) below `order`, of which V and B are the first
    /// two bands: channels `sh.4` ... `sh.<order^2 - 1>`, linear as V and B are; `mask` an interval of heights and how
    /// much of it is seen, in each of 16 columns of longitude; `cells` how much is seen of each of 144 cells of the
    /// sphere. The last two pack whole numbers into floats, which must be neither filtered nor stored as half, and
    /// bring the normal along; in the margin they are those of a neighbour.
    std::string basis = "vector";
    /// Bands of `sh`. Measured on six scenes under four skies (bench/ladder.py), in parts of the error of `paper`:
    /// 4 bands leave .59, 5 leave .51, 6 leave .46, 8 leave .38 (README, "What accuracy costs").
    /// Five, as half floats, take 50 bytes a texel.
    int order = 5;
    /// Whether a further channel is stored; a normal also because the basis needs it.
    VMLIGHT_API bool has(const std::string& channel) const;

    template <class Visit> void visit(Visit&& field)
    {
        field("resolution", resolution, SizeRange { 32768, 1 }, "Size of the map, in texels; one number is a square");
        field("width", width, Range { 0, 32768 }, "Width alone; 0 is that of resolution");
        field("height", height, Range { 0, 32768 }, "Height alone; 0 is that of resolution");
        field("udim", udim, Range { kFirstUdim, kLastUdim }, "UDIM tile to bake; <UDIM> in a name stands for it");
        field("samples", samples, Range { 1, 1 << 20 }, "Rays a texel");
        field("target_error", target_error, Range { 0, 1, "none", 0 }, "Take as many as it takes: RMS of V's error");
        field("sampler", sampler, Choices { { "fibonacci", "sobol", "halton" } }, "Where they go");
        field("seed", seed, Range { 0, 2147483647 }, "Same seed, same pixels, for any number of threads");
        field("measure", measure, Choices { { "cosine", "uniform" } }, "Weight of a direction in visibility");
        field("max_distance", max_distance, Range { 0, 1e30, "infinite", 0 }, "Ignore what is farther, in mesh units");
        field("margin", margin, Range { 0, 32768, "infinite", -1 }, "Texels to fill around what the mesh covers");
        field("channels", channels, Words { { "normal", "coverage", "error" } },
              "Add channels: the normal, for the model ao; 1 where the mesh covers the texel; V's standard error");
        field("basis", basis, basis_choices(), "Add what the model of this name reads; vector is nothing");
        field("order", order, Range { 3, 8 }, "Bands of the basis sh");
    }
};

/// Whether a channel of this name holds whole numbers below 2^24, as those of the bases `mask` and `cells` do: half
/// floats, filters and mipmaps would corrupt it.
VMLIGHT_API bool holds_whole_numbers(const std::string& channel);

/// What a bake did.
struct VismapReport
{
    UvReport uv;
    int64_t texels = 0; ///< of the whole map
    int64_t covered = 0; ///< of them covered by a triangle
    int64_t overlapping = 0; ///< of them covered by more than one
    int64_t tiny = 0; ///< triangles smaller than 4e-6 of the mesh: what is that near to them is not told apart
    /// By how much, in parts of the mesh's size (within a factor of 2), its farthest coordinate may be off if its
    /// coordinates are those of a file of floats: 3e-8 around the origin, more far from it. 0 if some are no floats.
    double rounding = 0;
    int64_t dark = 0; ///< of those covered, with visibility below 0.01: most, if normals point inwards
    int samples = 0; ///< rays a texel
    /// An estimate of the root mean square, over all covered texels, of V's distance from its limit for infinitely many
    /// rays from the same points by the same measure, from the scatter of some texels that are baked twice. It knows
    /// nothing of what none of their rays found, of the mesh's own errors, of the margin, or of how V varies within a
    /// texel. Measured on eight scenes, within 5 %. And how many texels: none unless an error, a time or the channel
    /// `error` was asked for.
    double error = 0;
    int64_t error_texels = 0;
    double expected_seconds = 0; ///< of the bake, if it was given a time
    double pilot_seconds = 0; ///< of the texels that were baked twice
    int64_t rays = 0; ///< traced; directions below the surface are not
    double build_seconds = 0, bake_seconds = 0, margin_seconds = 0;
};

/// Bake the visibility map of `mesh`.
///
/// @param dst      set to a float image of the asked-for size with channels `visibility`, `direction.x`, `direction.y`,
///                 `direction.z` (and those that `params.channels` asks for): V = (1/pi) Int vis(w) max(0, n.w) dw in
///                 [0, 1], and B = (1/pi) Int vis(w) max(0, n.w) w dw in object space, not normalised, |B| <= V. An
///                 open texel has V = 1 exactly and B = (2/3) n, one that sees nothing has 0 and 0. n is the
///                 interpolated normal; directions under the geometric surface count neither as seen nor as blocked.
///                 Texels that no triangle covers are 0 outside the margin. Row 0 is the top of the UDIM tile, v = 1.
///                 Tagged as data
/// @param mesh     triangles with uvs; a texel that several triangles cover goes to the lowest triangle index.
///                 Triangles without uvs cast and are not baked
/// @param occluders meshes in the same space that cast and are not baked
/// @param report   nullptr, or set to counts and times
/// @param nthreads 0 means OIIO's default. The result is bit-equal for every value.
/// @returns false, with the reason in `dst.geterror()`, if a parameter is out of range, the mesh has no uvs, a mesh
///          fails check_mesh() or reaches 1e18 times as far as `mesh`, the target
///          error is out of reach, the channel `error` is asked for with 1 ray, or memory runs out; `dst` then has no
///          pixels. Overlap, mirroring and texels outside the tile are counted, not refused.
/// Error (root mean square) of V, and of B as a vector, at n rays: at most 0.47 n^-0.75 by `fibonacci`, 0.6 n^-0.75 by
/// `sobol` and 0.65 n^-0.75 by `halton`, in any scene with a closed form that was tried.
VMLIGHT_API bool make_vismap(OIIO::ImageBuf& dst, const Mesh& mesh, const std::vector<Mesh>& occluders = {},
                             const VismapParams& params = {}, VismapReport* report = nullptr, int nthreads = 0,
                             const Progress& progress = {});

} // namespace vmlight
