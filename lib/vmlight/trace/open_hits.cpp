// SPDX-License-Identifier: Apache-2.0
// Embree's filter of hits on cut-outs.
#include <vmlight/trace/embree_scene.h>
#include <vmlight/trace/exact_hit.h>

#include <algorithm>
#include <cstring>

namespace vmlight::embree {

using Imath::V3f;

namespace {

// Bits that are those of no other ray of a texel: where it starts and where it goes are a function of texel, ray and
// seed, so that a number for each ray need not be passed along.
uint64_t ray_bits(const V3f& origin, const V3f& direction)
{
    uint64_t bits = 0;
    for (const V3f& v : { origin, direction })
        for (int axis = 0; axis < 3; ++axis) {
            uint32_t word;
            std::memcpy(&word, &v[axis], sizeof(word));
            bits = (bits ^ word) * 0x9e3779b97f4a7c15u;
            bits ^= bits >> 32;
        }
    return bits;
}

// Opacity at a hit, exactly: Embree's own u and v differ in their last bits from one instruction set to another.
double opacity_at_hit(const Buffers& buffers, const ExactHit& hit, CutoutWork& work)
{
    if (hit.is_beyond) {
        ++work.hits;
        return 0;
    }
    const Imath::V2d at = hit.weights();
    const double inside_u = at.x > 0 ? std::min(at.x, 1.0) : 0; // not a number: 0
    const double inside_v = at.y > 0 ? std::min(at.y, 1 - inside_u) : 0;
    return buffers.cutouts->opacity(hit.triangle, inside_u, inside_v, work);
}

// What the micromap says of a hit by Embree's own u and v; within an instance their error is not known.
CellState known_at_hit(const Buffers& buffers, const RTCFilterFunctionNArguments& arguments, unsigned i)
{
    if (placement_of(arguments, i))
        return CellState::unknown;
    RTCRayN* ray = arguments.ray;
    RTCHitN* hit = arguments.hit;
    const unsigned n = arguments.N, triangle = RTCHitN_primID(hit, n, i);
    const V3f along(RTCRayN_dir_x(ray, n, i), RTCRayN_dir_y(ray, n, i), RTCRayN_dir_z(ray, n, i));
    const V3f normal(RTCHitN_Ng_x(hit, n, i), RTCHitN_Ng_y(hit, n, i), RTCHitN_Ng_z(hit, n, i));
    const TrimmedPiece& piece = buffers.pieces[triangle];
    constexpr float kMapped = 5e-7f; // what rounding from the weights of a piece adds
    const float error = kMapped
        + piece.error_scale
            * weight_error(RTCRayN_tfar(ray, n, i) + piece.slack, piece.longest_edge, normal.dot(along));
    const float u = RTCHitN_u(hit, n, i), v = RTCHitN_v(hit, n, i);
    const auto lies_around = [error](const Imath::V2f& at) {
        return std::min({ at.x, at.y, 1 - at.x - at.y }) > -error;
    };
    const Imath::V2f at = piece.own.at(u, v);
    if (piece.partner == TrimmedPiece::kAlone || lies_around(at))
        return buffers.cutouts->known(triangle, at.x, at.y, error);
    const Imath::V2f beside = piece.of_partner.at(u, v);
    return lies_around(beside) ? buffers.cutouts->known(piece.partner, beside.x, beside.y, error) : CellState::unknown;
}

} // namespace

void reject_open_hits(const RTCFilterFunctionNArguments* arguments)
{
    const auto& buffers = *static_cast<const Buffers*>(arguments->geometryUserPtr);
    CutoutWork& work = static_cast<QueryContext*>(arguments->context)->cutouts;
    for (unsigned lanes = valid_lanes(arguments->valid, arguments->N); lanes; lanes &= lanes - 1) {
        const unsigned i = first_lane(lanes);
        const CellState known = known_at_hit(buffers, *arguments, i);
        if (known != CellState::unknown) { // nearly always
            ++work.hits;
            arguments->valid[i] = known == CellState::opaque ? -1 : 0;
            continue;
        }
        const ExactHit hit(buffers, *arguments, i);
        const double opacity = opacity_at_hit(buffers, hit, work);
        if (opacity <= 0
            || (opacity < 1
                && buffers.cutouts->passes(hit.triangle, opacity, ray_bits(hit.origin, hit.direction) ^ hit.bits)))
            arguments->valid[i] = 0;
    }
}

} // namespace vmlight::embree
