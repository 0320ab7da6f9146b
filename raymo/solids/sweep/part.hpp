// What bounds tell of the chords of a line through a part of a sweep; the letters are those of chords.cpp.
#pragma once

#include "raymo/solids/sweep/cubics.hpp"

namespace raymo::solids {

/// Cubics in a frame about a line: along it, beside it, above it, and the radius.
inline constexpr std::size_t kTau = 0, kP = 1, kQ = 2, kRadius = 3;

/// What is known of the sphere at one u, with derivatives by u.
struct SpherePlace {
    double u;
    double tau, tau1, tau2;
    double disc, disc1, disc2;
    double radius;
};
[[nodiscard]] SpherePlace place_at(const Cubics& q, double u);

/// A part of a piece, on [0, 1] again.
struct SweepPart {
    Cubics q;
    double u0, u1;  ///< where it is in the piece
    int depth;      ///< so often halved
};

/// E: by so much disc may be wrong, where it is near 0.
[[nodiscard]] inline double slack_of(double radius, double error) {
    return error * (2.0 * radius + error);
}

/// Bounds over a part, with derivatives by u of the piece.
struct PartBounds {
    std::array<double, 7> disc;  ///< coefficients
    double disc_least, disc_most;
    double d1_least;  ///< of |D1|; 0 where it has no sign
    bool d1_rises;
    double d2_most;  ///< of D2
    double tau_least, tau_most;
    double tau1_most;  ///< of |tau'|
    double tau2_least, tau2_most;
    double slack;     ///< E of the largest radius
    double rounding;  ///< of coefficients of disc
    double wide;      ///< H, with all errors

    /// Where disc is larger than this, it is positive for certain, with room.
    [[nodiscard]] double certain() const { return 4.0 * (slack + rounding); }
};

/// False: the line misses the part. `error`: of a place, a centre and a radius together.
[[nodiscard]] bool bound_part(const SweepPart& part, double error, PartBounds& out);

/// Whether there is at most one u in the part, for both signs together, where +-tau + h is stationary: the polynomial
/// D1^2 - 4 tau'^2 disc has at most one change of sign among its coefficients, all of them certain.
[[nodiscard]] bool at_most_one_stationary(const SweepPart& part, const PartBounds& bounds);

}  // namespace raymo::solids
