// What a surface does with light: facets, Fresnel's equations, body colour [Wijk86 2.6], [Blinn77].
//
// A surface is an interface over a body. The interface is a field of tiny mirrors (facets) whose
// normals h scatter about the surface normal n. With unit vectors to the viewer v and to the light
// l, and h halfway between them, the facets reflect
//     f = F(h.l) D(n.h) G / (4 n.l n.v)                                                     [1/sr]
// where
//     D  density of facet normals, scaled so that the facets cover the surface: its integral with
//        n.h over all directions is 1
//     G  = min(1, 2 n.h n.v / v.h, 2 n.h n.l / v.h), facets hiding each other in grooves
//     F  reflectance of one facet.
// `specular` and `mirror` state reflectances at normal incidence; with the angle they grow as those
// of a dielectric with the material's index of refraction do. A metal's reflectance starts from its
// colour instead of white.
// What the interface lets pass, going in and again coming out, meets the body: diffuse reflection,
// or transmission. Why: docs/decisions/0003-light-model.md.
#pragma once

#include <cstdint>

#include "raymo/scene/material.hpp"

namespace raymo::render {

using scene::Colour;

/// Part of unpolarised light that a smooth interface reflects, 0..1. `cosine` >= 0 of the angle of
/// incidence; `index` = (index behind) / (index before), > 0. 1 beyond the critical angle.
[[nodiscard]] double fresnel(double cosine, double index);

/// Reflectance that is stated by its value r at normal incidence and grows as Fresnel's F of an
/// index of refraction:
///     r / F(0) F                              for r below F(0): an interface that is partly covered
///     1 - (1 - r) (1 - F) / (1 - F(0))        above: it reflects more, and still all at grazing
/// Both are F itself where r is F(0).
struct Interface {
    double value = 0.0;  ///< at normal incidence
    double index = 1.0;  ///< of refraction
    // Reflectance = offset + scale * fresnel(cosine, index). What reflects nothing or everything does not grow.
    double offset = 0.0;
    double scale = 0.0;

    Interface() = default;
    /// `index` is brought into 1..3.7, where F never falls as the angle grows.
    Interface(double at_normal_incidence, double index);
    [[nodiscard]] double operator()(double cosine) const {
        return offset + scale * fresnel(cosine, index);
    }
    /// True when it reflects nothing at any angle.
    [[nodiscard]] bool none() const { return offset == 0.0 && scale == 0.0; }
};

/// Distribution of the facets' normals. `roughness` 0..1 sets the angle, up to 45 degrees, at which
/// the density has fallen to half [Blinn77]; all three distributions have it in common, so that
/// they can be exchanged.
struct Facets {
    scene::Facets kind;
    double shape;  ///< Trowbridge-Reitz: c3^2 - 1; Gaussian: c2^2; Phong: c1, in Blinn's letters
    double scale;

    Facets() : Facets(scene::Facets::trowbridge_reitz, 0.35) {}
    Facets(scene::Facets kind, double roughness);
    /// D [1/sr] for the cosine n.h > 0. Normalised: the integral of D cosine over the hemisphere
    /// is 1.
    [[nodiscard]] double density(double cosine) const;
};

/// G / (4 n.l n.v), the geometric part of the facet term, finite also at grazing angles. All
/// cosines > 0.
[[nodiscard]] double facet_geometry(double nh, double nv, double nl, double vh);

/// A material with all that does not depend on the ray worked out.
struct Surface {
    Colour body;         ///< of diffuse reflection, when all light reaches it
    Interface specular;  ///< of the facets, for the light of lamps and of the surroundings
    Interface mirror;    ///< for mirror images; unused where transparent
    Facets facets;
    Colour tint{1, 1,
                1};  ///< of what the interface reflects from above: white, or a metal's colour
    bool tinted = false;
    double metal = 0.0;
    bool transparent = false;
    double transmission = 0.0;
    double opaque_part = 1.0;   ///< 1 - transmission
    double least_mirror = 0.0;  ///< transparent: reflectance from above that the material asks for
    double index = 1.0;         ///< of refraction
    Vec3 absorption;            ///< [1/mm]
    bool absorbs = false;

    Surface() = default;
    explicit Surface(const scene::Material& material);

    /// Colour of an interface that reflects `reflectance` there, `normal_value` at normal
    /// incidence.
    [[nodiscard]] Colour reflected(double reflectance, double normal_value) const;
};

/// What is left of white light after `length` mm inside.
[[nodiscard]] Colour transmittance(const Surface& medium, double length);

/// Light reflected by facets for one unit of irradiance on a surface across the light: radiance is
/// this times irradiance times n.l. Times pi, as a light's power is that of a white diffuse surface
/// facing it.
[[nodiscard]] Colour facet_term(const Surface& surface, double nv, double nl, double vl);

/// Direction behind an interface (Snell's law); n.d < 0, `index` as in fresnel(). False: total
/// reflection.
[[nodiscard]] bool refracted_direction(Vec3 d, Vec3 n, double index, Vec3& out);

}  // namespace raymo::render
