// SPDX-License-Identifier: Apache-2.0
/// Visibility maps: how much of its hemisphere each texel of a mesh sees, and in which mean direction.
/// Source: I. Neulander, "Image-Based Diffuse Lighting Using Visibility Maps", section 2.
#pragma once

#include <vmlight/base/export.h>
#include <vmlight/base/params.h>
#include <vmlight/base/progress.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/uv/report.h>
#include <vmlight/uv/udim.h>

#include <OpenImageIO/imagebuf.h>

#include <limits>
#include <string>
#include <vector>

namespace vmlight {

/// The words that VismapParams::basis takes.
VMLIGHT_API Choices basis_choices();

struct VismapParams
{
    /// Texels. Width and height, if not 0, replace its sides.
    Size resolution { 1024, 1024 };
    int width = 0, height = 0;
    /// The UDIM tile of uv space to bake: 1001 + u + 10 v for the square with its lower left corner at (u, v).
    int udim = kFirstUdim;
    Size size() const { return { width ? width : resolution.width, height ? height : resolution.height }; }
    /// Rays per texel. Measured on six scenes, with reconstruction: with 64 rays the paper's model is within .5 % of
    /// the shading error that it has with 4096, and a model that also uses |B| within 1 %; `sh` of five bands is within
    /// 2 % with 128, and models that are not reconstructed need 1024.
    int samples = 64;
    /// The largest VismapReport::error, 0 to 1: the bake then chooses the rays per texel from some texels that it bakes
    /// twice, and ignores `samples`. 0 is off; as text, only the word "none" is.
    double target_error = 0;
    /// `auto`: V, B and the bands of `sh` of a texel are means over its own rays and those of neighbours that see the
    /// same, where the basis and the measure allow it (docs/accuracy.md). `off`: of its own rays alone. Does not apply
    /// to `sun_directions`, nor to maps with normals of their own.
    std::string reconstruct = "auto";
    /// Sample pattern. `fibonacci`, a lattice, has the least error at a fixed number of rays, and neighbouring texels
    /// shift it so that reconstruction gains more (docs/accuracy.md); `halton` is the paper's.
    std::string sampler = "fibonacci";
    /// Same seed, same pixels, for any number of threads.
    int seed = 0;
    /// `cosine`: V and B as in make_vismap(). `uniform`: V is the visible share of the hemisphere's solid angle, B has
    /// the direction of the cosine-weighted mean: the paper, read literally.
    std::string measure = "cosine";
    /// Maximum occluder distance, in mesh units.
    double max_distance = std::numeric_limits<double>::infinity();
    /// Whether the ground occludes: everything below the horizontal plane y = `ground_height`, in mesh units; texels
    /// below it see nothing. No ray is traced for it; where it is the only occluder, V and B are exact.
    bool ground = false;
    /// kLowest is the lowest point of the mesh; as text, only the word "lowest" is.
    double ground_height = kLowest;
    static constexpr double kLowest = -std::numeric_limits<double>::infinity();
    /// Whether texels that provably see everything are left untraced. Changes no pixel, and so is no parameter.
    bool skip_open = true;
    /// Texels to fill around the texels that the mesh covers; -1 fills the whole map.
    int margin = 16;
    /// Channels to add. `normal`: `normal.x`, `normal.y`, `normal.z`, the interpolated normal in object space, of unit
    /// length; in the margin a mean of neighbours, as B is, and so shorter: do not rely on its length. `coverage`: 1
    /// where a triangle covers the texel's centre, else 0. `error`: the standard error of V, from the scatter of each
    /// texel's rays, scaled so that its root mean square is VismapReport::error. It shows where the error is large
    /// better than how large it is: below 16 rays it is little more than whether the rays agree, and 0 does not prove
    /// that the next ray would. In the margin a mean of neighbours, as V is. Needs 2 rays per texel.
    std::vector<std::string> channels;
    /// What to store for shading models that read more than V and B (docs/accuracy.md). `vector`: nothing more. `sh`:
    /// the spherical harmonics of (1/pi) vis(w) max(0, n.w) below band `order`, of which V and B are the first two
    /// bands: channels `sh.4` ... `sh.<order^2 - 1>`, linear as V and B are. `mask`: for each of 16 columns of
    /// longitude, a visible range of heights and its density; channels `mask.0` ... `mask.10`. `cells`: how much of
    /// each of 144 cells of the sphere is visible; channels `cells.0` ... `cells.11`. The last two pack whole numbers
    /// below 2^24 into floats, which must be neither filtered nor stored as half, and add the channel `normal`; in the
    /// margin they repeat those of a neighbour. All but `vector` need the measure `cosine`.
    std::string basis = "vector";
    /// Bands of the basis `sh`. Measured on six scenes under four skies (bench/ladder.py), relative to the error of
    /// `paper`: 4 bands leave .59, 5 leave .51, 6 leave .46, 8 leave .38. Five bands take 50 bytes per texel as half.
    int order = 5;
    /// Discs of the sky in object space, such as suns, to store the visibility of: "x,y,z[,half angle in degrees];
    /// ...", the half angle of the sun without. Adds the channels `sun.0`, `sun.1`, ...: (1/(solid angle)) times the
    /// integral of vis(w) max(0, n.w) over the disc.
    std::string sun_directions;
    /// Whether the channel (a word of `channels`) is stored; `normal` also because a basis needs it.
    VMLIGHT_API bool has(const std::string& channel) const;

    template <class Visit> void visit(Visit&& field)
    {
        field("resolution", resolution, SizeRange { 32768, 1 }, "Size of the map in texels; one number for a square");
        field("width", width, Range { 0, 32768 }, advanced("Width in texels; 0: the width of resolution"));
        field("height", height, Range { 0, 32768 }, advanced("Height in texels; 0: the height of resolution"));
        field("udim", udim, Range { kFirstUdim, kLastUdim }, "UDIM tile to bake; replaces <UDIM> in file names");
        field("samples", samples, Range { 1, 1 << 20 }, "Rays per texel");
        field("target_error", target_error, Range { 1e-9, 1, "none", 0 },
              "Instead of a fixed count, choose one for this RMS error of visibility, such as 0.01");
        field("reconstruct", reconstruct,
              Choices { { { "auto", "where it is sound, also from neighbouring texels that see the same" },
                          { "off", "from each texel's own rays" } } },
              "Denoise visibility: less error from the same rays");
        field("sampler", sampler,
              Choices { { { "fibonacci", "Fibonacci lattice: lowest error at a fixed ray count" },
                          { "sobol", "Sobol sequence, Owen-scrambled" },
                          { "halton", "Halton sequence, as in Neulander's paper" } } },
              advanced("Sample pattern"));
        field("seed", seed, Range { 0, 2147483647 },
              advanced("Random seed; the same seed gives the same pixels on any number of threads"));
        field("measure", measure,
              Choices { { { "cosine", "weight directions by the cosine: what a diffuse surface receives" },
                          { "uniform", "weight all directions equally: the paper, read literally" } } },
              advanced("Weighting of directions"));
        field("max_distance", max_distance, Range { 1e-30, 1e30, "infinite", std::numeric_limits<double>::infinity() },
              "Maximum occluder distance, in mesh units");
        field("ground", ground, Flag {}, "Let everything below a horizontal plane occlude, without end");
        field("ground_height", ground_height, Range { -1e30, 1e30, "lowest", kLowest },
              "Height of the ground, in mesh units; lowest: the lowest point of the mesh");
        field("margin", margin, Range { 0, 32768, "infinite", -1 }, "Dilation around UV islands, in texels");
        field("channels", channels,
              ChoiceSet { { { "normal", "shading normal, for the model ao" },
                            { "coverage", "1 where the mesh covers the texel, else 0" },
                            { "error", "standard error of visibility" } } },
              "Extra channels to store");
        field("basis", basis, basis_choices(), "What else to store, for the shading model of the same name");
        field("order", order, Range { 3, 8 }, advanced("Number of bands of the basis sh"));
        field("sun_directions", sun_directions, Text { "X,Y,Z;..." },
              advanced("Suns to store the visibility of, as x,y,z[,HALF_ANGLE];... in object space and degrees"));
    }
};

/// Whether a channel of this name holds whole numbers below 2^24, as those of the bases `mask` and `cells` do: half
/// floats, filters and mipmaps would corrupt it.
VMLIGHT_API bool holds_whole_numbers(const std::string& channel);

/// Counts, error and times of a bake.
struct VismapReport
{
    UvReport uv;
    std::string normals_from; ///< Mesh::normals_from of the mesh
    std::vector<std::string> warnings; ///< Mesh::warnings of the mesh and its occluders, after their paths
    int64_t texels = 0; ///< of the whole map
    int64_t covered = 0; ///< texels that a triangle covers
    int64_t overlapping = 0; ///< texels that several triangles cover
    int64_t tiny = 0; ///< triangles smaller than 4e-6 of the mesh: occluders as close as that are not resolved
    /// Rounding of the coordinate farthest from the origin if they came from a file of floats, relative to the size of
    /// the mesh (within a factor of 2): 3e-8 for a mesh at the origin, more far from it. 0 if some were not floats.
    double rounding = 0;
    int64_t dark = 0; ///< covered texels with V below 0.01: most of them, if normals point inwards
    int samples = 0; ///< rays per texel
    /// Estimated root mean square error of V over the covered texels, against infinitely many rays from the same points
    /// by the same measure: from the scatter of `error_texels` texels that were baked twice. It excludes what none of
    /// their rays hit, errors of the mesh, the margin, and how V varies within a texel. Measured on eight scenes:
    /// within 5 %. Of a map that is reconstructed, bias included: from texels that are also traced with more rays. 0
    /// unless a target error, a time budget or the channel `error` was asked for.
    double error = 0;
    int64_t error_texels = 0;
    double expected_seconds = 0; ///< of the bake, if it had a time budget
    double pilot_seconds = 0; ///< of the texels that were baked twice
    int64_t rays = 0; ///< rays traced: directions below the surface are not, nor those that the ground blocks
    int64_t open = 0; ///< covered texels of triangles that nothing rises above: they trace no ray
    double build_seconds = 0, bake_seconds = 0, reconstruct_seconds = 0, margin_seconds = 0;
};

/// Bake the visibility map of `mesh`.
///
/// @param dst      set to a float image of params.size() with channels `visibility`, `direction.x`, `direction.y`,
///                 `direction.z` (and those of `params.channels` and `params.basis`): V = (1/pi) Int vis(w) max(0, n.w)
///                 dw in [0, 1], and B = (1/pi) Int vis(w) max(0, n.w) w dw in object space, not normalised, |B| <=
///                 (2/3) (1 - (1 - V)^(3/2)) <= V, the most that a surface can have (longest_direction.h).
///                 An unoccluded texel has V = 1 exactly and B = (2/3) n, a closed one 0 and 0. n is the interpolated
///                 normal; directions below the geometric surface count neither as visible nor as blocked. Texels
///                 outside triangles and margin are 0. Row 0 is the top of the UDIM tile, v = 1. Tagged as data
/// @param mesh     triangles with uvs; a texel that several triangles cover goes to the lowest triangle index.
///                 Triangles without uvs occlude and are not baked. Rays pass where Mesh::opacity says so
/// @param occluders meshes in the same space that occlude and are not baked
/// @param report   nullptr, or set to counts and times
/// @param nthreads 0 means OIIO's default. The result is the same bits for every value.
/// @returns false, with the reason in `dst.geterror()` and no pixels in `dst`, if a parameter is out of range, the mesh
///          has no uvs, a mesh fails check_mesh() or extends 1e18 times as far as `mesh`, the target error is out of
///          reach, the channel `error` is asked for with 1 ray, the basis needs another measure, memory runs out, or
///          `progress` stopped the work ("interrupted"). Overlapping, mirrored and outside uvs are counted in the
///          report, not refused.
/// Root mean square error of V, and of B as a vector, with n rays: at most 0.47 n^-0.75 by `fibonacci`, 0.6 n^-0.75 by
/// `sobol` and 0.65 n^-0.75 by `halton`, in every scene with a closed form that was tried.
VMLIGHT_API bool make_vismap(OIIO::ImageBuf& dst, const Mesh& mesh, const std::vector<Mesh>& occluders = {},
                             const VismapParams& params = {}, VismapReport* report = nullptr, int nthreads = 0,
                             const Progress& progress = {});

} // namespace vmlight
