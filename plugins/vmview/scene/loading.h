// SPDX-License-Identifier: Apache-2.0
/// From a request to assets: what is read, and what is baked because it is not there.
#pragma once

#include "../request.h"
#include "assets.h"

#include <vmlight/lightmap/model.h>

#include <functional>
#include <string>

namespace vmlight::view {

/// What the request opens.
MeshRequest mesh_request(const Request& request);

/// The bake that a model needs, for a mesh without a map: its basis, and what `ao` and false colours look at.
VismapParams bake_params(const VismapParams& asked, const std::string& model);
/// The same for strands: the best of their models replaces one of surfaces.
VismapParams strand_bake_params(const VismapParams& asked, const std::string& model);

/// Bake the whole map of `mesh`, and the maps of what is beside it, with `samples` rays per texel. nullptr, with the
/// reason in `error`: "interrupted" if it was stopped.
MapPointer bake_map(const MeshAsset& mesh, const std::string& model, int samples, const MakeOptions& options,
                    std::string& error);

/// `map`, which is of `mesh`, with the maps of what is beside that, baked as for bake_map(). nullptr, too, if it is
/// nullptr.
MapPointer with_maps_beside(MapPointer map, const MeshAsset& mesh, const std::string& model, int samples,
                            const MakeOptions& options, std::string& error);

/// All that a picture needs, read or baked one after the other.
struct Assets
{
    MeshPointer mesh;
    MapPointer map;
    LightPointer light; ///< nullptr without an environment
    TraceParams trace; ///< the request's, or what of it can be traced on the map
};
bool load_assets(Assets& dst, const Request& request, const MakeOptions& options, std::string& error);

/// The model to shade with, and what it reads: choose_model() for these two, of strand_model() if the map is one of
/// strands. False, with the reason in `error`.
bool model_for(ShadingModel& dst, const std::string& model, const MapAsset& map, const LightAsset& light,
               std::string& error);

/// The parameters of the light that falls on the object, `turn` degrees about y after its own rotation. Without
/// exposure, which is the picture's. False, with the reason in `error`, if they are no rotation.
bool light_params(LightmapParams& dst, const LightmapParams& asked, double turn, std::string& error);

} // namespace vmlight::view
