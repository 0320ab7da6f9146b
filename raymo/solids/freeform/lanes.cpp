// A packet of lines against patches. This file includes itself once for each instruction set (Highway's foreach_target).
//
// The rays go through the tree together, each with its own boxes, and so come to their leaves in the order in which they would
// alone. What a leaf asks of a line (search.cpp: whether it may be met, Newton's steps, whether they end at a crossing or
// leave) is computed for all lines side by side, by the same sums in the same order, so with the same bits. That is enough
// for most. Where it is not (steep places, borders, poles, tangents) the line meets this leaf alone. Rays with doubts in the
// end are left over.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raymo/solids/freeform/lanes.cpp"
#include "raymo/math/targets.hpp"
//
#include <hwy/foreach_target.h>  // must stand before highway.h
#include <hwy/highway.h>

#include <array>
#include <limits>

#include "raymo/math/lanes.hpp"
#include "raymo/math/tolerance.hpp"
#include "raymo/solids/freeform/freeform.hpp"
#include "raymo/solids/freeform/spans.hpp"
#include "raymo/solids/ray_block.hpp"

#ifndef RAYMO_FREEFORM_PACKET
#define RAYMO_FREEFORM_PACKET
namespace raymo::solids {

/// Eight lines, all of them set by set_lines(), and what has been found along each.
struct alignas(64) FreeformPacket {
    double o[3][8], along[3][8], side[3][8], up[3][8], error[8];
    SlabLanes slabs;
    FreeformFound found[8];

    [[nodiscard]] FreeformLine line(int i) const {
        const auto at = [i](const double(&from)[3][8]) {
            return Vec3{from[0][i], from[1][i], from[2][i]};
        };
        return {at(o), at(along), at(side), at(up), error[i]};
    }
};

}  // namespace raymo::solids
#endif

HWY_BEFORE_NAMESPACE();
namespace raymo::solids {
namespace HWY_NAMESPACE {
#include "raymo/math/lanes-inl.hpp"
#include "raymo/math/triple.inl"
#include "raymo/solids/interval.inl"
//
#include "raymo/solids/ray_block-inl.hpp"
#include "raymo/solids/slabs-inl.hpp"

struct LanePair {
    Lanes x, y;
};
RAYMO_INLINE Lanes cross(LanePair a, LanePair b) { return a.x * b.y - a.y * b.x; }
RAYMO_INLINE Lanes length(LanePair a) { return lane_sqrt(a.x * a.x + a.y * a.y); }

RAYMO_INLINE Lanes clamp(Lanes x, Lanes lo, Lanes hi) {
    return lane_select(x < lo, lo, lane_select(hi < x, hi, x));
}
RAYMO_INLINE Lanes negative(Lanes x) { return Lanes(hn::Neg(x.v)); }
RAYMO_INLINE Triple<Lanes> load(const double (&from)[3][8], int first) {
    return {load(from[0] + first), load(from[1] + first), load(from[2] + first)};
}
RAYMO_INLINE Triple<Lanes> spread(Vec3 v) { return {Lanes(v.x), Lanes(v.y), Lanes(v.z)}; }

struct LaneJet {
    Triple<Lanes> at, du, dv;
};
struct LaneWeights {
    Lanes value[4], slope[4];
    RAYMO_INLINE explicit LaneWeights(Lanes u) {
        const Lanes w = Lanes(1.0) - u;
        const Lanes uu = u * u;
        const Lanes ww = w * w;
        const Lanes uw = Lanes(2.0) * (u * w);
        const Lanes three(3.0);
        value[0] = ww * w;
        value[1] = three * (ww * u);
        value[2] = three * (uu * w);
        value[3] = uu * u;
        slope[0] = Lanes(-3.0) * ww;
        slope[1] = three * (ww - uw);
        slope[2] = three * (uw - uu);
        slope[3] = three * uu;
    }
};
/// Patch::at.
RAYMO_INLINE LaneJet jet_of(const Patch& patch, Lanes u, Lanes v) {
    const LaneWeights by_u(u);
    const LaneWeights by_v(v);
    const Lanes* f = by_v.value;
    const Lanes* g = by_v.slope;
    Lanes at[3], du[3], dv[3];
    for (std::size_t a = 0; a < 3; ++a) {
        const auto& rows = patch.c[a];
        Lanes p[4], pu[4], pv[4];
        for (std::size_t i = 0; i < 4; ++i) {
            const Lanes r0(rows[0][i]), r1(rows[1][i]), r2(rows[2][i]), r3(rows[3][i]);
            const Lanes value = (r0 * f[0] + r1 * f[1]) + (r2 * f[2] + r3 * f[3]);
            const Lanes slope = (r0 * g[0] + r1 * g[1]) + (r2 * g[2] + r3 * g[3]);
            p[i] = value * by_u.value[i];
            pu[i] = value * by_u.slope[i];
            pv[i] = slope * by_u.value[i];
        }
        at[a] = (p[0] + p[1]) + (p[2] + p[3]);
        du[a] = (pu[0] + pu[1]) + (pu[2] + pu[3]);
        dv[a] = (pv[0] + pv[1]) + (pv[2] + pv[3]);
    }
    return {{at[0], at[1], at[2]}, {du[0], du[1], du[2]}, {dv[0], dv[1], dv[2]}};
}

/// kLanes lines of a packet, from `first` on.
struct LaneLines {
    Triple<Lanes> o, along, side, up;
    Lanes error;
    RAYMO_INLINE LaneLines(const FreeformPacket& packet, int first)
        : o(load(packet.o, first)),
          along(load(packet.along, first)),
          side(load(packet.side, first)),
          up(load(packet.up, first)),
          error(load(packet.error + first)) {}
    RAYMO_INLINE LanePair across(Triple<Lanes> v) const { return {dot(v, side), dot(v, up)}; }
};

/// FreeformSearch's turns(), for the ball about b.
RAYMO_INLINE Mask turns(LanePair f, LanePair b, Lanes length_b, Lanes spread, Lanes way, Lanes e) {
    return way * cross(f, b) > spread * length(f) + e * (length_b + spread);
}

/// Meets a leaf with the lines of `asked` (bits from `first` on); returns those that must meet it alone.
RAYMO_INLINE std::uint32_t meet(const FreeformSurface& surface, const FreeformLeaf& leaf,
                                FreeformPacket& packet, int first, std::uint32_t asked) {
    const LaneLines line(packet, first);
    const LanePair p = line.across(spread(leaf.middle) - line.o);
    const LanePair a = line.across(spread(leaf.du));
    const LanePair b = line.across(spread(leaf.dv));
    const Lanes e = line.error;
    const Lanes su(leaf.spread_u), sv(leaf.spread_v);
    const Lanes turn = cross(a, b);
    const Lanes la = length(a), lb = length(b);
    const Lanes rest = Lanes(0.5 * (leaf.spread_u + leaf.spread_v)) + e;
    const Lanes pb = cross(p, b), pa = cross(p, a);
    const Lanes half = Lanes(0.5) * lane_abs(turn);
    const Mask missed = lane_or(lane_abs(pb) > half + rest * lb, lane_abs(pa) > half + rest * la);
    std::uint32_t active = asked & ~bits(missed);
    if (active == 0) return 0;
    const Mask steep = Lanes(2.0) * half <= su * lb + sv * la + su * sv;
    std::uint32_t alone = active & bits(steep);
    active &= ~alone;

    const PatchPart& part = leaf.part;
    const Lanes u0(part.u0), u1(part.u1), v0(part.v0), v1(part.v1);
    const Lanes low(-0.5), high(0.5);
    Lanes u = Lanes(0.5 * (part.u0 + part.u1)) +
              clamp(negative(pb) / turn, low, high) * Lanes(part.u1 - part.u0);
    Lanes v =
        Lanes(0.5 * (part.v0 + part.v1)) + clamp(pa / turn, low, high) * Lanes(part.v1 - part.v0);
    u = clamp(u, u0, u1);
    v = clamp(v, v0, v1);

    const Patch& patch = surface.patches[leaf.patch];
    const double bend = kBeyondPatch * patch.bend;
    const Lanes zero(0.0), one(1.0);
    const Lanes way = lane_select(turn > zero, one, Lanes(-1.0));
    const Lanes back = negative(way);
    for (int step = 0; step < kMostFreeformSteps && active != 0; ++step) {
        const LaneJet jet = jet_of(patch, u, v);
        const Triple<Lanes> from = jet.at - line.o;
        const LanePair f = line.across(from);
        const LanePair fu = line.across(jet.du);
        const LanePair fv = line.across(jet.dv);
        const Lanes turned = cross(fu, fv);
        const Lanes inverse = one / turned;
        const Lanes step_u = negative(cross(f, fv)) * inverse;
        const Lanes step_v = negative(cross(fu, f)) * inverse;
        const Lanes per_e = Lanes(2.0) * lane_abs(inverse);
        const Lanes blur_u = e * per_e * length(fv);
        const Lanes blur_v = e * per_e * length(fu);
        const Lanes next_u = u + step_u;
        const Lanes next_v = v + step_v;
        const Lanes size = lane_max(lane_abs(step_u), lane_abs(step_v));
        const Mask within = lane_and(lane_and(next_u >= u0 - blur_u, next_u <= u1 + blur_u),
                                     lane_and(next_v >= v0 - blur_v, next_v <= v1 + blur_v));
        const Mask near = Lanes(16.0 * bend) * (size * size) <= Lanes(kFreeformOwnError);
        const Lanes blur = lane_max(blur_u, blur_v);
        const Mask sure = lane_and(Lanes(2.0 * bend) * (blur * blur) <= e, blur <= Lanes(0.125));
        const Mask arrived = lane_and(within, near);
        // Next to where a border has shrunk to a point, other bounds may do.
        const Lanes uu = fu.x * fu.x + fu.y * fu.y;
        const Lanes vv = fv.x * fv.x + fv.y * fv.y;
        const Mask uneven = lane_or(uu < Lanes(1e-4) * vv, vv < Lanes(1e-4) * uu);
        const Mask good = turned * way > zero;
        std::uint32_t unclear = bits(lane_not(good)) |
                                (bits(within) & ~bits(lane_and(near, sure)) & bits(uneven)) |
                                (bits(arrived) & ~bits(sure));
        const Mask at_border = lane_or(lane_min(next_u, one - next_u) <= blur_u,
                                       lane_min(next_v, one - next_v) <= blur_v);
        unclear |= bits(arrived) & bits(at_border);
        unclear &= active;
        alone |= unclear;
        active &= ~unclear;
        const std::uint32_t hit = active & bits(arrived);
        if (hit != 0) {
            const Triple<Lanes> n = cross(jet.du, jet.dv);
            const Lanes slope = lane_abs(turned) / lane_sqrt(dot(n, n));
            alignas(64) double s[8], reach[8], at_u[8], at_v[8], off_u[8], off_v[8], sign[8];
            store(dot(from, line.along) + dot(jet.du, line.along) * step_u +
                      dot(jet.dv, line.along) * step_v,
                  s);
            store(Lanes(2.0) * e / slope, reach);
            store(next_u, at_u);
            store(next_v, at_v);
            store(blur_u, off_u);
            store(blur_v, off_v);
            store(turned, sign);
            for (std::uint32_t left = hit; left != 0; left &= left - 1) {
                const int i = __builtin_ctz(left);
                packet.found[first + i].add({s[i], reach[i], at_u[i], at_v[i], off_u[i], off_v[i],
                                             leaf.patch, sign[i] < 0.0 ? 1 : -1});
            }
            active &= ~hit;
        }
        const auto leaves = [&](Mask at_end, Mask outwards, LanePair axis, Lanes size_of_axis,
                                Lanes spread_of_axis, Lanes turning) RAYMO_INLINE_BODY {
            const Mask may = lane_and(at_end, outwards);
            if ((bits(may) & active) == 0) return;
            active &=
                ~bits(lane_and(may, turns(f, axis, size_of_axis, spread_of_axis, turning, e)));
        };
        leaves(u == u1, step_u > zero, b, lb, sv, back);
        leaves(u == u0, step_u < zero, b, lb, sv, way);
        leaves(v == v1, step_v > zero, a, la, su, way);
        leaves(v == v0, step_v < zero, a, la, su, back);
        const Lanes clamped_u = clamp(next_u, u0, u1);
        const Lanes clamped_v = clamp(next_v, v0, v1);
        const std::uint32_t stuck = active & bits(lane_and(clamped_u == u, clamped_v == v));
        alone |= stuck;
        active &= ~stuck;
        u = clamped_u;
        v = clamped_v;
    }
    return alone | active;
}

RAYMO_INLINE void meet_all(const FreeformSurface& surface, const FreeformLeaf& leaf,
                           FreeformPacket& packet, std::uint32_t asked) {
    for (int first = 0; first < 8; first += kLanes) {
        const std::uint32_t here = (asked >> first) & ((1U << kLanes) - 1U);
        if (here == 0) continue;
        for (std::uint32_t rest = meet(surface, leaf, packet, first, here); rest != 0;
             rest &= rest - 1) {
            const int i = first + __builtin_ctz(rest);
            const FreeformLine line = packet.line(i);
            FreeformSearch(surface, line, packet.found[i]).meet(leaf);
        }
    }
}

/// line_of() for the lines from `first` on.
RAYMO_INLINE void set_lines(const RayBlock& rays, int first, FreeformPacket& out) {
    const LocalRay<Lanes> ray = load(rays, first);
    const Lanes size = lane_sqrt(ray.dd);
    const Triple<Lanes> o{ray.ox, ray.oy, ray.oz};
    const Triple<Lanes> along{ray.dx / size, ray.dy / size, ray.dz / size};
    Triple<Lanes> side, up;
    lane_frame(along, side, up);
    const Lanes error = (ray.ex + ray.ey + ray.ez) + Lanes(4.0 * kFreeformOwnError);
    const auto put = [&](const Triple<Lanes>& v, double(&to)[3][8]) RAYMO_INLINE_BODY {
        store(v.x, to[0] + first);
        store(v.y, to[1] + first);
        store(v.z, to[2] + first);
    };
    put(o, out.o);
    put(along, out.along);
    put(side, out.side);
    put(up, out.up);
    store(error, out.error + first);
    const Lanes always(-std::numeric_limits<double>::infinity());
    set_slabs(o, along, error, always, first, out.slabs);
}

void freeform_walk(const FreeformSurface& surface, const RayBlock& rays, std::uint32_t asked,
                   FreeformPacket& packet) {
    for (int first = 0; first < 8; first += kLanes) set_lines(rays, first, packet);
    struct Waiting {
        std::uint32_t node;
        std::uint32_t rays;
    };
    std::array<Waiting, kMostFreeformWaiting> open;
    std::size_t count = 1;
    open[0] = {0, asked};
    while (count > 0) {
        const Waiting at = open[--count];
        const FreeformNode& node = surface.nodes[at.node];
        for (std::size_t k = 0; k < EightBoxes::kWidth; ++k) {
            const std::uint32_t here = at.rays & met(packet.slabs, node.boxes, k);
            if (here == 0) continue;
            const std::uint32_t child = node.child[k];
            if ((child & FreeformNode::kLeaf) != 0) {
                meet_all(surface, surface.leaves[child & ~FreeformNode::kLeaf], packet, here);
            } else {
                open[count++] = {child, here};
            }
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace raymo::solids
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace raymo::solids {

HWY_EXPORT(freeform_walk);

void Freeform::spans(const RayBlock& rays, std::uint32_t asked, SpanBlock& out) const {
    const FreeformSurface& surface = *surface_;
    const auto ray_of = [&](int i) {
        return LocalRay<double>{rays.o[0][i], rays.o[1][i], rays.o[2][i], rays.d[0][i],
                                rays.d[1][i], rays.d[2][i], rays.e[0][i], rays.e[1][i],
                                rays.e[2][i], rays.dd[i],   rays.from[i]};
    };
    FreeformPacket packet;
    HWY_DYNAMIC_DISPATCH(freeform_walk)(surface, rays, asked, packet);
    out.count = 0;
    out.left_over = 0;
    for (std::uint32_t& valid : out.valid) valid = 0;
    for (std::uint32_t rest = asked; rest != 0; rest &= rest - 1) {
        const int i = __builtin_ctz(rest);
        const FreeformFound& found = packet.found[i];
        if (found.doubts.empty() && found.hits.empty()) continue;
        SpanList spans;
        if (!found.doubts.empty() || !tell_certain(found, ray_of(i), spans) || spans.touched() ||
            spans.degenerate() || spans.size() > kSweptSpans) {
            out.left_over |= 1U << i;
            continue;
        }
        for (std::size_t k = 0; k < spans.size(); ++k) {
            const auto put = [&](const SpanEnd& end, SpanBlock::End& to) {
                to.s[k][i] = end.s;
                to.error[k][i] = end.error;
                to.face[k][i] = end.face;
            };
            put(spans[k].enter, out.enter);
            put(spans[k].exit, out.exit);
            out.valid[k] |= 1U << i;
            if (out.count <= static_cast<int>(k)) out.count = static_cast<int>(k) + 1;
        }
    }
}

}  // namespace raymo::solids
#endif
