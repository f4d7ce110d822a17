// SPDX-License-Identifier: Apache-2.0
/// What decides on effects: numbers that are known before the work, or cheap to find.
#pragma once

#include <vmlight/trace/caster_reach.h>
#include <vmlight/trace/cutouts.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace vmlight {

/// Of a bake. Lengths are in mesh units.
struct BakeFacts
{
    int64_t triangles = 0; ///< of the baked mesh, with UVs; where `proven`, also with an area
    int64_t open_triangles = 0; ///< of them, those that nothing rises above
    double open_share = 0; ///< of the area in UV
    bool proven = false; ///< whether every triangle was looked at
    int64_t covered = 0, texels = 0; ///< texels that the mesh covers, of the map

    int64_t tests = 0; ///< what deciding took: boxes, triangles and vertices compared with a horizon

    std::vector<CasterReach> occluders;
    CutoutCounts cutouts;
    bool no_cutouts = false; ///< not asked for: every material is opaque

    bool has_normal_map = false, has_flat_normal_map = false;
    bool has_material_normals = false; ///< it is that of the materials

    bool has_ground = false;
    double ground_height = 0, lowest = 0; ///< of the plane; of the mesh
    bool faces_up = false; ///< every texel, straight: none sees what is below it
    double diagonal = 0; ///< of the box around mesh and occluders
    /// Length of rays; and as it is asked for, even if it is switched off.
    double reach = std::numeric_limits<double>::infinity(), given_reach = reach;
    std::string no_reconstruct {}; ///< why texels are not averaged with their neighbours, or ""
    int margin = 0;
    int udim = 1001;
    bool udim_given = false, half = false;

    int64_t poses = 1; ///< of the mesh, in all
    /// By how much V of a texel that keeps what it has in another pose may be off; less than 0: no texel does.
    double pose_error = -1;
};

/// Of a lightmap.
struct LightFacts
{
    bool converts_color = false; ///< whether environment, light, albedo or result change their colour space
    std::string color_note;
    double rotation_degrees = 0; ///< angle of the rotation as a whole
    bool has_albedo = false;
    /// Least and most of all colours of the albedo, black where the file has none. Crossed: not read, as it is
    /// switched off.
    double albedo_low = 0, albedo_high = 0;
    int levels = 0; ///< images of the light that the model reads
    std::string model;
    bool has_environment = false; ///< rather than filtered light
    bool is_one_color = false; ///< the light, whatever it is filtered by, without its suns
    bool is_black = false; ///< the light, with its suns
    bool is_rest = false; ///< its suns were split off it
    int64_t lit = 0, shadowed = 0; ///< texels with V above 0; of them, with V below 1
    int64_t hidden = 0; ///< pixels with V = 0: texels that see no sky, or none
    bool wants_bounce = false; ///< one is asked for
    int bounce_rays = 0; ///< of a texel
    double traced_rays = 0; ///< of all texels; 0 where that is not known, or an earlier lightmap traced them
    double traced_points = 0; ///< off the map, each with rays of its own
    bool wants_suns = false; ///< asked for
    std::string no_suns {}; ///< why they cannot be traced, or ""
    int suns = 0; ///< that the light has, if they are asked for and can be traced, without
    int wide_discs = 0; ///< of the wide lights beside them
    double sun_share = 0; ///< of all light
    bool has_stored_suns = false; ///< the map stores what texels see of them, as they are turned
    std::string no_bounce {}; ///< why it cannot be traced, or ""
};

/// "1 sun", "2 suns and 4 wide discs": of LightFacts.
std::string suns_count_text(int suns, int wide_discs);

struct EffectFacts
{
    BakeFacts bake;
    LightFacts light;
};

} // namespace vmlight
