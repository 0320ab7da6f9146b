// A packet of rays against one leaf, for kernels whose code is too long to be compiled into the walk.
//
// Such a kernel answers  spans(const RayBlock&, std::uint32_t asked, SpanBlock&)  beside the questions of solids/primitive.hpp:
// for the rays that are `asked`, one bit each, with the bits that spans() gives, or by leaving a ray over for
// spans_in_full(), which is right for all rays, but slower. spans() does the same for a single ray.
#pragma once

#include <cstdint>

#include "raymo/solids/span.hpp"

namespace raymo::solids {

/// Rays in the frame of a leaf; see LocalRay.
struct RayBlock {
    alignas(64) double o[3][8];
    alignas(64) double d[3][8];
    alignas(64) double e[3][8];
    alignas(64) double dd[8];
    alignas(64) double from[8];
};

/// Their spans, none of which is a touch or degenerate.
struct SpanBlock {
    int count;                         ///< that a ray has at most
    std::uint32_t left_over;           ///< rays of which nothing is told
    std::uint32_t valid[kSweptSpans];  ///< which rays have span i
    struct End {
        alignas(64) double s[kSweptSpans][8], error[kSweptSpans][8], face[kSweptSpans][8];
    } enter, exit;
};

/// Places on faces of a leaf, in its frame, or normals there.
struct PlaceBlock {
    alignas(64) double p[3][8];
    alignas(64) double face[8];
};

/// Kernels that answer packets.
template <class K>
concept BlockKernel = requires(const K k, const RayBlock rays, const LocalRay<double> ray,
                               std::uint32_t asked, SpanBlock& spans, PlaceBlock& places,
                               SpanList& list) {
    k.spans(rays, asked, spans);
    k.normals(places, asked);  ///< as normal(), in place of p
    k.spans_in_full(ray, list);
};

}  // namespace raymo::solids
