#include "raymo/render/light_model.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "raymo/render/sampling.hpp"

using namespace raymo;
using namespace raymo::render;

namespace {

constexpr double kPi = std::numbers::pi;
constexpr scene::Facets kAllFacets[] = {scene::Facets::trowbridge_reitz, scene::Facets::gaussian,
                                        scene::Facets::phong};

Vec3 at_angles(double polar, double azimuth) {
    return {std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
            std::cos(polar)};
}

/// Part of the light from direction `l` that leaves the surface z = 0 in all directions by the
/// facets and the body: the integral of (f + body / pi) cos over the hemisphere, by even points
/// that lie densest around the mirror direction.
double albedo(const Surface& s, Vec3 l, bool facets_only) {
    constexpr std::uint32_t kPoints = 40000;
    double sum = 0.0;
    for (std::uint32_t k = 0; k < kPoints; ++k) {
        const Point2 p = sample_point(k, 7);
        // Cosine-weighted directions: dw cos = pi du dv.
        const double r = std::sqrt(p.u);
        const Vec3 v{r * std::cos(2 * kPi * p.v), r * std::sin(2 * kPi * p.v),
                     std::sqrt(1.0 - p.u)};
        if (v.z <= 0.0) continue;
        sum += facet_term(s, v.z, l.z, dot(v, l)).y;
        if (!facets_only) {
            sum += s.body.y * (1.0 - s.specular(l.z)) * (1.0 - s.specular(v.z));
        }
    }
    return sum / kPoints;
}

}  // namespace

TEST_CASE("fresnel: normal incidence, grazing, Brewster's angle and total reflection") {
    CHECK(fresnel(1.0, 1.5) == doctest::Approx(0.04));
    CHECK(fresnel(1.0, 1.0 / 1.5) == doctest::Approx(0.04));
    CHECK(fresnel(0.0, 1.5) == doctest::Approx(1.0));
    CHECK(fresnel(0.3, 1.0) == doctest::Approx(0.0));
    // At Brewster's angle the parallel component is not reflected; the other one is ((n^2 - 1) /
    // (n^2 + 1))^2.
    const double n = 1.5;
    const double across = (n * n - 1.0) / (n * n + 1.0);
    CHECK(fresnel(std::cos(std::atan(n)), n) == doctest::Approx(0.5 * across * across));
    // From inside: total beyond the critical angle, not before.
    const double critical = std::sqrt(1.0 - 1.0 / (n * n));
    CHECK(fresnel(critical * 0.999, 1.0 / n) == 1.0);
    CHECK(fresnel(critical * 1.01, 1.0 / n) < 0.9);
}

TEST_CASE("fresnel: equals the textbook's two polarisations at all angles") {
    for (const double n : {0.7, 1.1, 1.33, 1.5, 2.4}) {
        for (int i = 1; i < 90; ++i) {
            const double a = i * kPi / 180.0;
            const double sin_b = std::sin(a) / n;
            if (sin_b >= 1.0) {
                CHECK(fresnel(std::cos(a), n) == 1.0);
                continue;
            }
            const double b = std::asin(sin_b);
            const double s = std::sin(a - b) / std::sin(a + b);
            const double p = std::tan(a - b) / std::tan(a + b);
            CHECK(fresnel(std::cos(a), n) == doctest::Approx(0.5 * (s * s + p * p)).epsilon(1e-9));
        }
    }
}

TEST_CASE("fresnel: the same from both sides along the same path") {
    for (int i = 1; i < 90; ++i) {
        const double a = i * kPi / 180.0;
        const double b = std::asin(std::sin(a) / 1.5);
        CHECK(fresnel(std::cos(a), 1.5) == doctest::Approx(fresnel(std::cos(b), 1.0 / 1.5)));
    }
}

TEST_CASE("interface: keeps what it states at normal incidence and grows to grazing") {
    for (const double index : {1.0, 1.33, 1.5, 2.4, 9.0}) {
        for (const double r : {0.01, 0.04, 0.3, 0.9, 0.999}) {
            const Interface interface(r, index);
            CHECK(interface(1.0) == doctest::Approx(r));
            if (r > 0.4) CHECK(interface(0.0) == doctest::Approx(1.0));
            for (int i = 1; i <= 90; ++i) {
                const double before = interface(std::cos((i - 1) * kPi / 180.0));
                const double after = interface(std::cos(i * kPi / 180.0));
                CHECK(after >= before - 1e-12);
                CHECK(after <= 1.0 + 1e-12);
            }
        }
    }
    const Interface glass(0.04, 1.5);
    for (const double c : {0.1, 0.5, 0.9}) CHECK(glass(c) == doctest::Approx(fresnel(c, 1.5)));
    CHECK(Interface(0.0, 1.5)(0.1) == 0.0);
    CHECK(Interface(0.0, 1.5).none());
    CHECK(Interface(1.0, 1.5)(0.7) == 1.0);
}

TEST_CASE("facets: every distribution covers the surface once") {
    for (const auto kind : kAllFacets) {
        for (const double roughness : {0.05, 0.2, 0.5, 1.0}) {
            const Facets facets(kind, roughness);
            double sum = 0.0;
            constexpr int kSteps = 200000;
            for (int i = 0; i < kSteps; ++i) {
                const double a = (i + 0.5) * (kPi / 2.0) / kSteps;
                sum += facets.density(std::cos(a)) * std::cos(a) * std::sin(a);
            }
            CAPTURE(roughness);
            CHECK(sum * 2.0 * kPi * (kPi / 2.0) / kSteps == doctest::Approx(1.0).epsilon(1e-5));
        }
    }
}

TEST_CASE("facets: all distributions fall to half at the same angle") {
    for (const auto kind : kAllFacets) {
        for (const double roughness : {0.02, 0.3, 1.0}) {
            const Facets facets(kind, roughness);
            const double half = std::cos(roughness * kPi / 4.0);
            CHECK(facets.density(half) == doctest::Approx(0.5 * facets.density(1.0)));
        }
    }
}

TEST_CASE("facets: zero roughness stays finite") {
    for (const auto kind : kAllFacets) {
        const Facets facets(kind, 0.0);
        CHECK(std::isfinite(facets.density(1.0)));
        CHECK(facets.density(1.0) > 1000.0);
        CHECK(facets.density(0.5) >= 0.0);
    }
}

TEST_CASE("facet geometry: Blinn's attenuation, and finite at grazing angles") {
    const double nh = 0.9;
    const double nv = 0.4;
    const double nl = 0.7;
    const double vh = 0.8;
    const double g = std::min({1.0, 2 * nh * nv / vh, 2 * nh * nl / vh});
    CHECK(facet_geometry(nh, nv, nl, vh) == doctest::Approx(g / (4 * nl * nv)));
    CHECK(facet_geometry(0.5, 1e-300, 0.3, 0.5) < 10.0);
}

TEST_CASE("facet term: exchanging eye and light changes nothing") {
    scene::Material material;
    material.specular = 0.3;
    for (const auto kind : kAllFacets) {
        material.facets = kind;
        const Surface surface(material);
        for (int i = 0; i < 100; ++i) {
            const Point2 p = sample_point(static_cast<std::uint32_t>(i), 1);
            const Point2 q = sample_point(static_cast<std::uint32_t>(i), 2);
            const Vec3 v = at_angles(1.5 * p.u, 6.0 * p.v);
            const Vec3 l = at_angles(1.5 * q.u, 6.0 * q.v);
            CHECK(facet_term(surface, v.z, l.z, dot(v, l)).x ==
                  doctest::Approx(facet_term(surface, l.z, v.z, dot(v, l)).x));
        }
    }
}

TEST_CASE("furnace: no surface sends back more light than it gets") {
    for (const auto kind : kAllFacets) {
        for (const double roughness : {0.2, 0.35, 0.7, 1.0}) {
            for (const double specular : {0.0, 0.04, 0.25, 0.8, 1.0}) {
                scene::Material material;
                material.color = {1, 1, 1};
                material.diffuse = 1.0;
                material.facets = kind;
                material.roughness = roughness;
                material.specular = specular;
                const Surface surface(material);
                for (const double degrees : {0.0, 30.0, 60.0, 80.0}) {
                    CAPTURE(roughness);
                    CAPTURE(specular);
                    CAPTURE(degrees);
                    const double all =
                        albedo(surface, at_angles(degrees * kPi / 180.0, 0.3), false);
                    CHECK(all < 1.005);
                    if (specular == 0.0) CHECK(all == doctest::Approx(1.0));
                }
            }
        }
    }
}

TEST_CASE("furnace: nearly all light from above is sent back by mirrors that hardly scatter") {
    scene::Material material;
    material.specular = 1.0;
    material.roughness = 0.15;
    material.facets = scene::Facets::gaussian;
    CHECK(albedo(Surface(material), {0, 0, 1}, true) == doctest::Approx(1.0).epsilon(0.02));
}

TEST_CASE("metals: their colour from above, white at grazing") {
    scene::Material material;
    material.color = {1.0, 0.6, 0.2};
    material.metal = 1.0;
    material.specular = 0.9;
    const Surface surface(material);
    const Colour above = surface.reflected(0.9, 0.9);
    CHECK(above.x == doctest::Approx(0.9));
    CHECK(above.z == doctest::Approx(0.18));
    const Colour grazing = surface.reflected(1.0, 0.9);
    CHECK(grazing.x == doctest::Approx(1.0));
    CHECK(grazing.z == doctest::Approx(1.0));
}

TEST_CASE("refraction: Snell's law and unit directions") {
    const Vec3 n{0, 0, 1};
    for (int i = 0; i < 90; i += 5) {
        const double a = i * kPi / 180.0;
        const Vec3 d{std::sin(a), 0, -std::cos(a)};
        Vec3 t;
        REQUIRE(refracted_direction(d, n, 1.5, t));
        CHECK(t.x == doctest::Approx(std::sin(a) / 1.5));
        CHECK(norm(t) == doctest::Approx(1.0).epsilon(1e-14));
        Vec3 back;
        REQUIRE(refracted_direction(t, n, 1.0 / 1.5, back));
        CHECK(norm(back - d) < 1e-7);
    }
    Vec3 t;
    CHECK_FALSE(refracted_direction({0.8, 0, -0.6}, n, 1.0 / 1.5, t));
}

TEST_CASE("absorption: falls exponentially, by colour") {
    scene::Material material;
    material.transmission = 1.0;
    material.absorption = {0.1, 0.0, 2.0};
    const Colour c = transmittance(Surface(material), 5.0);
    CHECK(c.x == doctest::Approx(std::exp(-0.5)));
    CHECK(c.y == 1.0);
    CHECK(c.z == doctest::Approx(std::exp(-10.0)));
}

TEST_CASE("materials out of range are clipped, not believed") {
    scene::Material material;
    material.color = {5, -1, std::nan("")};
    material.diffuse = 7;
    material.specular = -3;
    material.transmission = 2;
    const Surface surface(material);
    CHECK(surface.body == Colour{0, 0, 0});
    CHECK(surface.specular.none());
    CHECK(surface.transmission == 1.0);
}
