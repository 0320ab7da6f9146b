// What a ball leaves of two solids that it is rolled along, by the definition of it alone.
//
// The union of P and Q with its edges filled by a ball of radius r is the closing of the union: what no open ball of radius r
// can reach that stays outside of P and Q [Rossignac86]. The centres of such balls are C = { c: p(c) >= r and q(c) >= r }, with
// p and q the distances from P and Q, so
//     x is in the closing   <=>   the distance of x from C is at least r.
// The point of C nearest to x is x itself, or the foot of x on p = r or on q = r, or the nearest point of the spine
// p = q = r, which is looked for by Newton's method from the nearest of many points of it. All in extended precision. The
// intersection and the difference follow by complements: (P & Q) opened is the complement of (-P | -Q) closed.
//
// Where only some edges are blended, x is filled only between the two contacts of the ball of such an edge, on its side of the
// spine. That a spine belongs to an edge shows as it is followed from r = 0 on.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "raymo/math/affine.hpp"
#include "tests/laws/law.hpp"
#include "tests/laws/model.hpp"

namespace raymo::laws {

struct RealVec {
    Real x = 0, y = 0, z = 0;

    friend RealVec operator+(RealVec a, RealVec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend RealVec operator-(RealVec a, RealVec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend RealVec operator*(RealVec a, Real s) { return {a.x * s, a.y * s, a.z * s}; }
};
[[nodiscard]] Real dot(RealVec a, RealVec b);
[[nodiscard]] RealVec cross(RealVec a, RealVec b);
[[nodiscard]] Real norm(RealVec a);
[[nodiscard]] RealVec unit(RealVec a);
[[nodiscard]] RealVec real(Vec3 a);
[[nodiscard]] Vec3 rounded(RealVec a);

/// A direction in the plane across n, in which `along` is: along that, across it or at any angle, exactly or nearly. Of unit length
/// or nearly.
[[nodiscard]] Vec3 flat_direction(RealVec n, RealVec along, Random& random);

/// A solid with one surface. The distance from it is exact everywhere, negative within.
struct RealSurface {
    enum class Kind : std::uint8_t { plane, sphere, cylinder, cone, torus } kind = Kind::plane;
    RealVec point, axis{0, 0, 1};  ///< the cone's apex; it opens along the axis
    Real radius = 0, tube = 0, half_angle = 0;
    Real side = 1;  ///< -1: the complement

    [[nodiscard]] Real distance(RealVec p) const;
    [[nodiscard]] RealVec gradient(RealVec p) const;
    /// Whether the nearest point of the surface is one where it is smooth: not the apex.
    [[nodiscard]] bool has_smooth_foot(RealVec p) const;
    [[nodiscard]] RealSurface complement() const;
    /// The image under a similarity.
    [[nodiscard]] RealSurface mapped(const Affine& map) const;
};

/// A plane, or the half of one where u >= 0, in which two surfaces are looked at.
struct RealSection {
    RealVec origin, u, v;
    bool is_half = false;

    [[nodiscard]] RealVec at(Real x, Real y) const { return origin + u * x + v * y; }
};

class Rolled {
public:
    Rolled(const RealSurface& p, const RealSurface& q, Real size) : p_(p), q_(q), size_(size) {}

    [[nodiscard]] const RealSurface& p() const { return p_; }
    [[nodiscard]] const RealSurface& q() const { return q_; }
    /// Points of a section within `reach` of its origin at which p = q = r.
    [[nodiscard]] std::vector<RealVec> level(const RealSection& section, Real r, Real reach) const;
    /// From a point where p = q = 0, the point where p = q = r that belongs to it, as r grows; nothing where the way
    /// there ends. `reached`: the largest r on the way, to 1e-9 of it.
    [[nodiscard]] std::optional<RealVec> follow(const RealSection& section, RealVec edge, Real r,
                                                Real& reached) const;

    /// Points all along one spine p = q = r, close to each other.
    struct Spine {
        std::vector<RealVec> points;
        Real reach =
            0;  ///< how far from it the edge is that it blends; 0: of an edge that is not blended
    };
    void roll(Real r, std::vector<Spine> spines) {
        r_ = r;
        spines_ = std::move(spines);
    }
    /// From where the foot of a point on a spine is looked for: from the nearest of its points, or from all that are about as
    /// near, since where a spine bends as sharply as the ball, it has several feet.
    enum class Care : std::uint8_t { quick, thorough };
    /// Where x is in the union with the blended edges closed, unless within `margin` of the boundary.
    [[nodiscard]] Side closing(RealVec x, Real margin, Care care = Care::quick) const;
    /// Whether a point of a spine belongs to an edge: it is followed as r shrinks to 0. A ball that touches both solids where
    /// they are close to each other, but do not meet, does not.
    [[nodiscard]] bool is_of_edge(RealVec centre) const;
    /// The point where p = q = r that shortest steps lead to.
    [[nodiscard]] std::optional<RealVec> nearby(RealVec x, Real r) const;
    /// The nearest point of the spines, and the number of its spine.
    struct Nearest {
        RealVec at;
        std::size_t spine;
    };
    [[nodiscard]] std::optional<Nearest> on_spine(RealVec x, Care care = Care::quick) const;

private:
    /// The foot of x on a spine that Newton's method finds from y.
    [[nodiscard]] std::optional<RealVec> polished_foot(RealVec x, RealVec y) const;
    /// Where steps along the spine from y, which is on it, come nearest to x.
    [[nodiscard]] RealVec approached(RealVec x, RealVec y) const;
    /// The nearest to x of places along the spine up to about r to both sides of y, which is on it.
    [[nodiscard]] RealVec nearest_along(RealVec x, RealVec y) const;
    /// The foot of x on a spine that is found from y, which is on it; none that is farther.
    [[nodiscard]] std::optional<RealVec> foot_from(RealVec x, RealVec y) const;
    [[nodiscard]] bool is_between_contacts(RealVec x, RealVec centre) const;
    [[nodiscard]] std::optional<RealVec> solve(const RealSection& section, Real r,
                                               RealVec start) const;

    RealSurface p_, q_;
    Real size_;  ///< of what is looked at, for roundings
    Real r_ = 0;
    std::vector<Spine> spines_;
};

}  // namespace raymo::laws
