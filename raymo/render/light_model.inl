// The formulas of light_model.hpp for one ray or several (see math/lanes.hpp). Included once per instruction set.

#include "raymo/math/triple.inl"

template <class R>
RAYMO_INLINE R largest(Triple<R> a) {
    return lane_max(a.x, lane_max(a.y, a.z));
}

// Fresnel's equations for unpolarised light, with g = n cos(refracted): F = 1/2 ((g - c) / (g + c))^2
// (1 + ((c (g + c) - 1) / (c (g - c) + 1))^2).
template <class R>
RAYMO_INLINE R fresnel_of(R cosine, R index) {
    const R one(1.0);
    const R g2 = index * index - one + cosine * cosine;
    const R g = lane_sqrt(lane_max(g2, R(0.0)));
    const R sum = g + cosine;
    const R difference = g - cosine;
    // Both quotients over one denominator.
    const R below = cosine * difference + one;
    const R inverse = one / (sum * below);
    const R across = difference * below * inverse;
    const R ratio = (cosine * sum - one) * sum * inverse;
    return lane_select(g2 > R(0.0), R(0.5) * across * across * (one + ratio * ratio), one);
}

// Of Trowbridge and Reitz.
template <class R>
RAYMO_INLINE R facet_density(R cosine, R shape, R scale) {
    const R s = cosine * cosine * shape + R(1.0);
    return scale / (s * s);
}

// min(1, 2 nh nv / vh, 2 nh nl / vh) / (4 nl nv): the least of the three, with the division carried out in each.
template <class R>
RAYMO_INLINE R facet_geometry_of(R nh, R nv, R nl, R vh) {
    const R lesser = lane_max(lane_min(nv, nl), R(0x1p-400));
    const R greater = lane_max(nv, nl);
    const R inverse = R(1.0) / (lesser * greater * vh);
    const R open = R(0.25) * vh * inverse;
    const R grooved = R(0.5) * nh * lesser * inverse;
    return lane_min(grooved, open);
}

// From tint * value at normal incidence to white at grazing; `tinted` where there is a tint at all.
template <class R, class M>
RAYMO_INLINE Triple<R> reflected_colour(M tinted, Triple<R> tint, R reflectance, R normal_value) {
    Triple<R> out{reflectance, reflectance, reflectance};
    if (!lane_any(tinted)) return out;
    const M full = lane_not(normal_value < R(1.0));
    const R growth =
        (reflectance - normal_value) / lane_select(full, R(1.0), R(1.0) - normal_value);
    const R coloured = lane_select(full, reflectance, normal_value * (R(1.0) - growth));
    const R white = lane_select(full, R(0.0), growth);
    out.x = lane_select(tinted, tint.x * coloured + white, out.x);
    out.y = lane_select(tinted, tint.y * coloured + white, out.y);
    out.z = lane_select(tinted, tint.z * coloured + white, out.z);
    return out;
}

// Snell's law; `there`: where there is no total reflection. Unit up to rounding, which repeated refraction would add up.
template <class R, class M>
RAYMO_INLINE Triple<R> refracted_of(Triple<R> d, Triple<R> n, R index, M& there) {
    const R cosine = R(0.0) - dot(d, n);
    const R g2 = index * index - R(1.0) + cosine * cosine;
    there = g2 > R(0.0);
    const R step = cosine - lane_sqrt(lane_max(g2, R(0.0)));
    const Triple<R> out = (d + n * step) * (R(1.0) / index);
    return out * (R(1.5) - R(0.5) * dot(out, out));
}
