// One text for all instruction sets: this file includes itself once for each (Highway's foreach_target). Every operation is
// one correctly rounded IEEE operation on each lane, so all give the same picture.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raymo/render/shade.cpp"
#include "raymo/render/shade.hpp"

#include "raymo/math/targets.hpp"
//
#include <hwy/foreach_target.h>  // must stand before highway.h
#include <hwy/highway.h>

#include <limits>
#include <numbers>

#include "raymo/math/lanes.hpp"

HWY_BEFORE_NAMESPACE();
namespace raymo::render {
namespace HWY_NAMESPACE {
#include "raymo/math/lanes-inl.hpp"
#include "raymo/render/light_model.inl"
//
#include "raymo/render/lamps.inl"
#include "raymo/render/lane_rows-inl.hpp"

using trace::end_of;
using trace::first_lanes;
using Colours = Triple<Lanes>;

HWY_INLINE Colours load(const double (&v)[3][kRays], int first) {
    return {load(v[0] + first), load(v[1] + first), load(v[2] + first)};
}
HWY_INLINE void store(const Colours& c, double (&v)[3][kRays], int first) {
    store(c.x, v[0] + first);
    store(c.y, v[1] + first);
    store(c.z, v[2] + first);
}
HWY_INLINE Colours lane_select(Mask mask, const Colours& yes, const Colours& no) {
    return {lane_select(mask, yes.x, no.x), lane_select(mask, yes.y, no.y),
            lane_select(mask, yes.z, no.z)};
}
HWY_INLINE Mask mask_at(LaneBits lanes, int first) { return mask_of(lanes >> first); }

void eye_rays_in_lanes(const scene::View& view, const double (&x)[kRays], const double (&y)[kRays],
                       trace::RayPacket& rays) {
    rays.on_surface = 0;
    for (int first = 0; first < kRays; first += kLanes) {
        const Colours d = everywhere<Lanes>(view.corner()) +
                          everywhere<Lanes>(view.step_x()) * load(x + first) +
                          everywhere<Lanes>(view.step_y()) * load(y + first);
        const Colours eye = everywhere<Lanes>(view.eye());
        if (view.parallel()) {
            store(eye + d, rays.o, first);
            store(everywhere<Lanes>(view.forward()), rays.d, first);
        } else {
            store(eye, rays.o, first);
            store(d * (Lanes(1.0) / lane_sqrt(dot(d, d))), rays.d, first);
        }
        store(Lanes(std::numeric_limits<double>::infinity()), rays.t_max + first);
        store(Lanes(0.0), rays.start_error + first);
    }
}

void shade_background_in_lanes(const Surroundings& around, const double (&view)[3][kRays],
                               double (&light)[3][kRays]) {
    const Colours bottom = everywhere<Lanes>(around.background.bottom);
    const Colours top = everywhere<Lanes>(around.background.top);
    for (int first = 0; first < kRays; first += kLanes) {
        const Lanes up = Lanes(0.5) + Lanes(0.5) * load(view[2] + first);
        store(bottom * (Lanes(1.0) - up) + top * up, light, first);
    }
}

LaneBits met_alike_in_lanes(const trace::HitPacket& hits, int lane) {
    return equal_in_row(hits.material, lane) & equal_in_row(hits.medium_before, lane) &
           equal_in_row(hits.medium_after, lane);
}

/// The surfaces of some lanes, to take their numbers from.
struct SurfacesInLanes {
    const Surface* base;
    const Surface* const* all;
    hn::Vec<hn::RebindToSigned<D>> offset;  ///< of each lane's from `base`, in bytes
    bool same;

    [[nodiscard]] HWY_INLINE const Surface& at(int lane) const { return same ? *base : *all[lane]; }
    HWY_INLINE Lanes operator()(const double& member) const {
        return same ? Lanes(member) : Lanes(hn::GatherOffset(D(), &member, offset));
    }
    HWY_INLINE Colours operator()(const Vec3& member) const {
        return {(*this)(member.x), (*this)(member.y), (*this)(member.z)};
    }
    HWY_INLINE Lanes reflectance(const Interface& interface, Lanes cosine) const {
        return (*this)(interface.offset) +
               (*this)(interface.scale) * fresnel_of(cosine, (*this)(interface.index));
    }
};
HWY_INLINE SurfacesInLanes surfaces_at(const Spots& spots, int first) {
    const hn::RebindToSigned<D> integer;
    alignas(64) std::int64_t offset[kRays] = {};
    const Surface* base = spots.surface[first];
    const auto address = [](const Surface* s) { return reinterpret_cast<std::intptr_t>(s); };
    if (!spots.same) {
        for (int i = 0; i < kLanes; ++i)
            offset[i] = address(spots.surface[first + i]) - address(base);
    }
    return {base, spots.surface + first, hn::Load(integer, offset), spots.same};
}

void shade_surroundings_in_lanes(const Surroundings& around, const double (&view)[3][kRays],
                                 const trace::HitPacket& hits, LaneBits lanes, Spots& spots,
                                 Onward& reflected, Onward& refracted) {
    const Lanes one(1.0);
    const Lanes none(0.0);
    const Colours ambient = everywhere<Lanes>(around.ambient);
    const Colours bottom = everywhere<Lanes>(around.background.bottom);
    const Colours top = everywhere<Lanes>(around.background.top);
    spots.lit = lanes & ~spots.dark & (~spots.transparent | hits.entering);
    reflected.lanes = refracted.lanes = 0;
    for (int first = 0; first < end_of(lanes); first += kLanes) {
        const SurfacesInLanes surface = surfaces_at(spots, first);
        const Surface& base = *surface.base;
        const Mask tinted = mask_at(spots.tinted, first);
        const Mask clear = mask_at(spots.transparent, first);
        const Colours d = load(view, first);
        const Colours outward = load(hits.normal, first);
        const Colours n =
            lane_select(mask_at(hits.entering, first), outward, outward * Lanes(-1.0));
        const Lanes dn = dot(d, n);
        // Rounding may put a surface seen edge-on on the wrong side.
        const Lanes nv = lane_max(none - dn, Lanes(1e-9));
        const Colours image = d - n * (dn + dn);

        // What is dark has no facets.
        const Lanes facets =
            (lanes & ~spots.dark) == 0 ? none : surface.reflectance(base.specular, nv);
        Lanes mirror = none;
        Lanes from_above = none;
        if (spots.mirrors != 0) {
            mirror = surface.reflectance(base.mirror, nv);
            from_above = surface(base.mirror.value);
        }
        const Lanes index = load(spots.index + first);
        if (lane_any(clear)) {
            const Lanes least = lane_select(index == one, none, surface(base.least_mirror));
            mirror = lane_select(clear, lane_max(fresnel_of(nv, index), least), mirror);
            // Only a tint asks for it.
            if (spots.tinted != 0)
                from_above = lane_select(clear, fresnel_of(one, index), from_above);
        }
        const Colours body = surface(base.body) * ((one - facets) * (one - mirror));
        Colours light = body * ambient;
        const Mask glossy = facets > mirror;
        const Colours tint = spots.tinted != 0 ? surface(base.tint) : Colours{one, one, one};
        if (lane_any(glossy)) {
            // What facets that are not traced reflect. Mostly that is other parts, in ambient light; but a metal shows little
            // else than what is around it, so half of that is taken from the backdrop.
            Colours from = ambient;
            if (spots.tinted != 0) {
                const Lanes up = Lanes(0.5) + Lanes(0.5) * image.z;
                const Colours behind = bottom * (one - up) + top * up;
                from = ambient + (behind - ambient) * (Lanes(0.5) * surface(base.metal));
            }
            const Colours colour =
                reflected_colour(tinted, tint, facets, surface(base.specular.value));
            const Lanes part =
                (facets - mirror) * surface(base.opaque_part) / lane_max(facets, Lanes(0x1p-500));
            light = lane_select(glossy, light + from * colour * part, light);
        }
        store(n, spots.normal, first);
        store(nv, spots.nv + first);
        store(body, spots.body, first);
        store(light, spots.light, first);

        const Mask bright = lane_and(mask_at(lanes, first), mirror > none);
        const Colours weight = load(spots.weight, first);
        if (lane_any(bright)) {
            const Mask all = mirror >= one;
            const Colours full = lane_select(clear, Colours{one, one, one}, tint);
            const Colours part =
                lane_select(all, full, reflected_colour(tinted, tint, mirror, from_above));
            store(image, reflected.d, first);
            store(weight * part, reflected.weight, first);
            reflected.lanes |= bits(bright) << first;
        }
        const Mask through = lane_and(mask_at(lanes, first), lane_and(clear, mirror < one));
        if (lane_any(through)) {
            Mask there = through;
            const Colours bent = refracted_of(d, n, index, there);
            store(bent, refracted.d, first);
            store(weight * (surface(base.transmission) * (one - mirror)), refracted.weight, first);
            refracted.lanes |= bits(lane_and(through, there)) << first;
        }
    }
}

LaneBits worth_tracing_in_lanes(const Onward& onward, double least) {
    LaneBits worth = 0;
    for (int first = 0; first < end_of(onward.lanes); first += kLanes)
        worth |= bits(largest(load(onward.weight, first)) >= Lanes(least)) << first;
    return worth & onward.lanes;
}

void shade_passage_in_lanes(const trace::HitPacket& hits, const double (&view)[3][kRays],
                            LaneBits lanes, const double (&transmission)[kRays],
                            const double (&ratio)[kRays], double (&left)[kRays]) {
    for (int first = 0; first < end_of(lanes); first += kLanes) {
        const Lanes cosine = lane_abs(dot(load(hits.normal, first), load(view, first)));
        const Lanes passed =
            load(transmission + first) * (Lanes(1.0) - fresnel_of(cosine, load(ratio + first)));
        const Lanes before = load(left + first);
        store(lane_select(mask_at(lanes, first), before * passed, before), left + first);
    }
}

/// A lamp's light on some spots.
struct LitInLanes {
    Colours light;
    ArrivalOf<Lanes> way;
    Mask counts;
};
HWY_INLINE LitInLanes lit(const Lamp& lamp, Colours point, Colours normal, Colours view, Lanes nv,
                          Colours body, Colours weight, double least,
                          const SurfacesInLanes& surface, LaneBits slow, Mask tinted, Lanes u,
                          Lanes v, Mask lanes) {
    const Lanes none(0.0);
    const Lanes one(1.0);
    const Surface& base = *surface.base;
    LitInLanes out;
    out.counts = lanes;
    out.way = arrival(lamp, point, u, v, out.counts);
    const Lanes nl = dot(normal, out.way.direction);
    out.counts = lane_and(out.counts, nl > none);

    // body (1 - F) + pi F D G / (4 n.l n.v): a light's power is that of a white diffuse surface facing it.
    const Lanes vl = none - dot(view, out.way.direction);
    const Lanes vh = lane_sqrt(lane_max(none, Lanes(0.5) * (one + vl)));
    const Mask facing = vh > none;
    const Lanes some_vh = lane_select(facing, vh, one);
    const Lanes some_nl = lane_max(nl, none);
    const Lanes nh = lane_min(one, (some_nl + nv) / (some_vh + some_vh));
    Lanes density = facet_density(nh, surface(base.facets.shape), surface(base.facets.scale));
    slow &= first_lanes(kLanes);
    if (slow != 0) {
        alignas(64) double cosines[kRays], densities[kRays];
        store(nh, cosines);
        store(density, densities);
        for (; slow != 0; slow &= slow - 1) {
            const int i = trace::lowest_lane(slow);
            densities[i] = surface.at(i).facets.density(cosines[i]);
        }
        density = load(densities);
    }
    const Lanes facets = lane_select(
        facing, Lanes(std::numbers::pi) * density * facet_geometry_of(nh, nv, some_nl, some_vh),
        none);
    const Colours tint = lane_any(tinted) ? surface(base.tint) : Colours{one, one, one};
    const Colours colour = reflected_colour(
        tinted, tint, surface.reflectance(base.specular, some_vh), surface(base.specular.value));
    const Colours returned =
        body * (one - surface.reflectance(base.specular, some_nl)) + colour * facets;
    out.light = everywhere<Lanes>(lamp.power) * (out.way.share * nl) * returned;
    out.counts = lane_and(out.counts, largest(out.light * weight) > Lanes(least));
    return out;
}

HWY_INLINE void put(const LitInLanes& lit, Colours point, Lanes point_error, int first,
                    Gains& gains, trace::RayPacket& shadows) {
    store(lit.light, gains.light, first);
    gains.lanes |= bits(lit.counts) << first;
    store(point, shadows.o, first);
    store(lit.way.direction, shadows.d, first);
    store(lit.way.distance, shadows.t_max + first);
    store(point_error, shadows.start_error + first);
}

void shade_by_lamp_in_lanes(const Lamp& lamp, const double (&view)[3][kRays],
                            const trace::HitPacket& hits, LaneBits lanes, const Spots& spots,
                            double least, Gains& gains, trace::RayPacket& shadows) {
    gains.lanes = 0;
    shadows.on_surface = trace::kAllLanes;
    const Lanes half(0.5);
    for (int first = 0; first < end_of(lanes); first += kLanes) {
        const Colours point = load(hits.point, first);
        put(lit(lamp, point, load(spots.normal, first), load(view, first), load(spots.nv + first),
                load(spots.body, first), load(spots.weight, first), least,
                surfaces_at(spots, first), spots.slow >> first, mask_at(spots.tinted, first), half,
                half, mask_at(lanes, first)),
            point, load(hits.point_error + first), first, gains, shadows);
    }
}

void add_gains_in_lanes(const Gains& gains, Spots& spots) {
    for (int first = 0; first < end_of(gains.lanes); first += kLanes) {
        const Mask there = mask_at(gains.lanes, first);
        const Colours light = load(spots.light, first);
        store(lane_select(there, light + load(gains.light, first), light), spots.light, first);
    }
}

void shade_by_lamp_places_in_lanes(const Lamp& lamp, const double (&view)[3][kRays],
                                   const trace::HitPacket& hits, int hit, LaneBits lanes,
                                   const double (&u)[kRays], const double (&v)[kRays],
                                   const Spots& spots, double least, Gains& gains,
                                   trace::RayPacket& shadows) {
    gains.lanes = 0;
    shadows.on_surface = trace::kAllLanes;
    const auto all = [hit](const double(&values)[3][kRays]) {
        return Colours{Lanes(values[0][hit]), Lanes(values[1][hit]), Lanes(values[2][hit])};
    };
    const Colours point = all(hits.point);
    const auto everywhere_if = [hit](LaneBits which) {
        return (which >> hit & 1U) != 0 ? trace::kAllLanes : 0U;
    };
    const SurfacesInLanes surface{spots.surface[hit], nullptr, hn::Zero(hn::RebindToSigned<D>()),
                                  true};
    const LaneBits slow = everywhere_if(spots.slow);
    const Mask tinted = mask_of(everywhere_if(spots.tinted));
    for (int first = 0; first < end_of(lanes); first += kLanes) {
        put(lit(lamp, point, all(spots.normal), all(view), Lanes(spots.nv[hit]), all(spots.body),
                all(spots.weight), least, surface, slow, tinted, load(u + first), load(v + first),
                mask_at(lanes, first)),
            point, Lanes(hits.point_error[hit]), first, gains, shadows);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace raymo::render
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace raymo::render {

HWY_EXPORT(eye_rays_in_lanes);
HWY_EXPORT(shade_background_in_lanes);
HWY_EXPORT(met_alike_in_lanes);
HWY_EXPORT(shade_surroundings_in_lanes);
HWY_EXPORT(worth_tracing_in_lanes);
HWY_EXPORT(shade_passage_in_lanes);
HWY_EXPORT(shade_by_lamp_in_lanes);
HWY_EXPORT(add_gains_in_lanes);
HWY_EXPORT(shade_by_lamp_places_in_lanes);

void eye_rays(const scene::View& view, const double (&x)[kRays], const double (&y)[kRays],
              trace::RayPacket& rays) {
    HWY_DYNAMIC_DISPATCH(eye_rays_in_lanes)(view, x, y, rays);
}
void shade_background(const Surroundings& around, const double (&view)[3][kRays],
                      double (&light)[3][kRays]) {
    HWY_DYNAMIC_DISPATCH(shade_background_in_lanes)(around, view, light);
}
LaneBits met_alike(const trace::HitPacket& hits, int lane) {
    return HWY_DYNAMIC_DISPATCH(met_alike_in_lanes)(hits, lane);
}
void shade_surroundings(const Surroundings& around, const double (&view)[3][kRays],
                        const trace::HitPacket& hits, LaneBits lanes, Spots& spots,
                        Onward& reflected, Onward& refracted) {
    HWY_DYNAMIC_DISPATCH(shade_surroundings_in_lanes)
    (around, view, hits, lanes, spots, reflected, refracted);
}
LaneBits worth_tracing(const Onward& onward, double least) {
    return HWY_DYNAMIC_DISPATCH(worth_tracing_in_lanes)(onward, least);
}
void shade_passage(const trace::HitPacket& hits, const double (&view)[3][kRays], LaneBits lanes,
                   const double (&transmission)[kRays], const double (&ratio)[kRays],
                   double (&left)[kRays]) {
    HWY_DYNAMIC_DISPATCH(shade_passage_in_lanes)(hits, view, lanes, transmission, ratio, left);
}
void shade_by_lamp(const Lamp& lamp, const double (&view)[3][kRays], const trace::HitPacket& hits,
                   LaneBits lanes, const Spots& spots, double least, Gains& gains,
                   trace::RayPacket& shadows) {
    HWY_DYNAMIC_DISPATCH(shade_by_lamp_in_lanes)
    (lamp, view, hits, lanes, spots, least, gains, shadows);
}
void add_gains(const Gains& gains, Spots& spots) {
    HWY_DYNAMIC_DISPATCH(add_gains_in_lanes)(gains, spots);
}
void shade_by_lamp_places(const Lamp& lamp, const double (&view)[3][kRays],
                          const trace::HitPacket& hits, int hit, LaneBits lanes,
                          const double (&u)[kRays], const double (&v)[kRays], const Spots& spots,
                          double least, Gains& gains, trace::RayPacket& shadows) {
    HWY_DYNAMIC_DISPATCH(shade_by_lamp_places_in_lanes)
    (lamp, view, hits, hit, lanes, u, v, spots, least, gains, shadows);
}

}  // namespace raymo::render
#endif
