#include "raymo/render/light_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "raymo/math/lanes.hpp"

namespace raymo::render {
namespace {

#include "raymo/render/light_model.inl"

double clamp01(double x) { return x > 0.0 ? (x < 1.0 ? x : 1.0) : 0.0; }
Colour clamp01(Colour c) { return {clamp01(c.x), clamp01(c.y), clamp01(c.z)}; }

/// 2 pi times the integral of exp(-c2^2 a^2) cos a sin a over 0 <= a <= pi/2, by Simpson's rule
/// over the part where the integrand is not negligible (beyond 6.1 / c2 the factor is below 2^-53).
double gaussian_integral(double c2_squared) {
    const double end = std::min(std::numbers::pi / 2.0, 6.1 / std::sqrt(c2_squared));
    constexpr int kSteps = 128;
    double sum = 0.0;
    for (int i = 0; i <= kSteps; ++i) {
        const double a = end * i / kSteps;
        const double weight = i == 0 || i == kSteps ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
        sum += weight * std::exp(-c2_squared * a * a) * std::sin(a) * std::cos(a);
    }
    return 2.0 * std::numbers::pi * sum * end / (3.0 * kSteps);
}

}  // namespace

double fresnel(double cosine, double index) { return fresnel_of(cosine, index); }

Interface::Interface(double at_normal_incidence, double of_refraction)
    : value(clamp01(at_normal_incidence)),
      index(of_refraction > 1.0 ? std::min(of_refraction, 3.7) : 1.0) {
    const double own = fresnel(1.0, index);
    if (value == 0.0 || value == 1.0) {
        offset = value;
    } else if (value < own) {
        scale = value / own;
    } else {
        scale = (1.0 - value) / (1.0 - own);
        offset = 1.0 - scale;
    }
}

Facets::Facets(scene::Facets of_kind, double roughness) : kind(of_kind) {
    // Sharper than this a highlight is thinner than any pixel, and the density overflows.
    constexpr double kSharpest = 0.004;
    const double half = std::max(clamp01(roughness), kSharpest) * std::numbers::pi / 4.0;
    const double c = std::cos(half);
    const double s = std::sin(half);
    if (kind == scene::Facets::trowbridge_reitz) {
        const double c3_squared = s * s / (std::numbers::sqrt2 - c * c);
        shape = c3_squared - 1.0;
        scale = c3_squared / std::numbers::pi;
    } else if (kind == scene::Facets::gaussian) {
        shape = std::numbers::ln2 / (half * half);
        scale = 1.0 / gaussian_integral(shape);
    } else {
        shape = -std::numbers::ln2 / std::log1p(-2.0 * std::sin(half / 2.0) * std::sin(half / 2.0));
        scale = (shape + 2.0) / (2.0 * std::numbers::pi);
    }
}

double Facets::density(double cosine) const {
    if (kind == scene::Facets::trowbridge_reitz) return facet_density(cosine, shape, scale);
    if (kind == scene::Facets::gaussian) {
        const double angle = std::acos(std::min(cosine, 1.0));
        return scale * std::exp(-shape * angle * angle);
    }
    return scale * std::exp2(shape * std::log2(std::min(cosine, 1.0)));
}

double facet_geometry(double nh, double nv, double nl, double vh) {
    return facet_geometry_of(nh, nv, nl, vh);
}

Surface::Surface(const scene::Material& material)
    : specular(material.specular, material.ior),
      mirror(material.mirror, material.ior),
      facets(material.facets, material.roughness) {
    const Colour color = clamp01(material.color);
    transmission = clamp01(material.transmission);
    opaque_part = 1.0 - transmission;
    transparent = transmission > 0.0;
    body = color * (clamp01(material.diffuse) * opaque_part);
    metal = clamp01(material.metal);
    tinted = metal > 0.0;
    tint = Colour{1, 1, 1} * (1.0 - metal) + color * metal;
    least_mirror = transparent ? clamp01(material.mirror) : 0.0;
    index = transparent ? std::max(material.ior, 1.0) : 1.0;
    absorption = max(material.absorption, Vec3{});
    absorbs = transparent && max_norm(absorption) > 0.0;
}

Colour Surface::reflected(double reflectance, double normal_value) const {
    const auto c =
        reflected_colour(tinted, Triple<double>{tint.x, tint.y, tint.z}, reflectance, normal_value);
    return {c.x, c.y, c.z};
}

Colour transmittance(const Surface& medium, double length) {
    if (!medium.absorbs) return {1, 1, 1};
    const Vec3 a = medium.absorption;
    // 0 * infinity is no absorption.
    const auto part = [&](double k) { return k > 0.0 ? std::exp(-k * length) : 1.0; };
    return {part(a.x), part(a.y), part(a.z)};
}

Colour facet_term(const Surface& surface, double nv, double nl, double vl) {
    const double vh = std::sqrt(std::max(0.0, 0.5 * (1.0 + vl)));
    if (vh <= 0.0) return {};
    const double nh = std::min(1.0, (nl + nv) / (2.0 * vh));
    const double f = surface.specular(vh);
    const double rest =
        std::numbers::pi * surface.facets.density(nh) * facet_geometry(nh, nv, nl, vh);
    return surface.reflected(f, surface.specular.value) * rest;
}

bool refracted_direction(Vec3 d, Vec3 n, double index, Vec3& out) {
    bool there = false;
    const auto r =
        refracted_of(Triple<double>{d.x, d.y, d.z}, Triple<double>{n.x, n.y, n.z}, index, there);
    if (there) out = {r.x, r.y, r.z};
    return there;
}

}  // namespace raymo::render
