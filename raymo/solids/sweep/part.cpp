#include "raymo/solids/sweep/part.hpp"

#include <algorithm>
#include <cmath>

#include "raymo/math/tolerance.hpp"

namespace raymo::solids {

SpherePlace place_at(const Cubics& q, double u) {
    const CubicsJet j = jet_at(q, u);
    const auto sum = [](const std::array<double, 4>& a, const std::array<double, 4>& b) {
        return a[kRadius] * b[kRadius] - a[kP] * b[kP] - a[kQ] * b[kQ];
    };
    return {u,
            j.value[kTau],
            j.first[kTau],
            j.second[kTau],
            sum(j.value, j.value),
            2.0 * sum(j.value, j.first),
            2.0 * (sum(j.first, j.first) + sum(j.value, j.second)),
            std::fabs(j.value[kRadius])};
}

bool bound_part(const SweepPart& part, double error, PartBounds& b) {
    const Cubics& q = part.q;
    b.disc = {};
    add_square(q, kRadius, 1.0, b.disc);
    add_square(q, kP, -1.0, b.disc);
    add_square(q, kQ, -1.0, b.disc);
    double size = 0.0;
    double radius = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
        size = std::max(size, q.c[i][kP] * q.c[i][kP] + q.c[i][kQ] * q.c[i][kQ]);
        radius = std::max(radius, std::fabs(q.c[i][kRadius]));
    }
    // The halvings have added 3 roundings each to the numbers that are left.
    size += radius * radius;
    b.rounding = 8.0 * kUnitRoundoff * (1.0 + 0.5 * part.depth) * size;
    b.slack = slack_of(radius, error);
    b.disc_most = *std::max_element(b.disc.begin(), b.disc.end());
    if (!(b.disc_most > -(b.slack + b.rounding))) return false;
    b.disc_least = *std::min_element(b.disc.begin(), b.disc.end());
    b.wide = std::sqrt(std::max(b.disc_most, 0.0) + b.slack + b.rounding);

    b.tau_least = b.tau_most = q.c[0][kTau];
    for (std::size_t i = 1; i < 4; ++i) {
        b.tau_least = std::min(b.tau_least, q.c[i][kTau]);
        b.tau_most = std::max(b.tau_most, q.c[i][kTau]);
    }
    const double scale = 1.0 / (part.u1 - part.u0);
    std::array<double, 6> d1;
    for (std::size_t i = 0; i < 6; ++i) d1[i] = b.disc[i + 1] - b.disc[i];
    double low = d1[0];
    double high = d1[0];
    double bend = d1[1] - d1[0];
    for (std::size_t i = 1; i < 6; ++i) {
        low = std::min(low, d1[i]);
        high = std::max(high, d1[i]);
        bend = std::max(bend, d1[i] - d1[i - 1]);
    }
    b.d1_rises = low > 0.0;
    b.d1_least = 6.0 * scale * std::max({low, -high, 2.0 * b.rounding}) - 12.0 * scale * b.rounding;
    b.d2_most = 30.0 * scale * scale * (bend + 4.0 * b.rounding);
    const double t0 = q.c[1][kTau] - q.c[0][kTau];
    const double t1 = q.c[2][kTau] - q.c[1][kTau];
    const double t2 = q.c[3][kTau] - q.c[2][kTau];
    b.tau1_most = 3.0 * scale * std::max({std::fabs(t0), std::fabs(t1), std::fabs(t2)});
    b.tau2_most = 6.0 * scale * scale * std::max(t1 - t0, t2 - t1);
    b.tau2_least = 6.0 * scale * scale * std::min(t1 - t0, t2 - t1);
    return true;
}

bool at_most_one_stationary(const SweepPart& part, const PartBounds& b) {
    // Coefficients multiplied by their binomials, so that products are plain; derivatives over the part, divided by 6
    // (D1) and by 3 (tau'). So the polynomial is 36 (D1^2 - tau'^2 disc).
    constexpr std::array<double, 3> kTwo{1, 2, 1};
    constexpr std::array<double, 6> kFive{1, 5, 10, 10, 5, 1};
    constexpr std::array<double, 7> kSix{1, 6, 15, 20, 15, 6, 1};
    constexpr std::array<double, 11> kTen{1, 10, 45, 120, 210, 252, 210, 120, 45, 10, 1};
    std::array<double, 6> d;
    double d_most = 0.0;
    for (std::size_t i = 0; i < 6; ++i) {
        const double x = b.disc[i + 1] - b.disc[i];
        d_most = std::max(d_most, std::fabs(x));
        d[i] = kFive[i] * x;
    }
    std::array<double, 3> t;
    double t_most = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double x = part.q.c[i + 1][kTau] - part.q.c[i][kTau];
        t_most = std::max(t_most, std::fabs(x));
        t[i] = kTwo[i] * x;
    }
    const std::array<double, 5> tt{t[0] * t[0], 2.0 * t[0] * t[1], 2.0 * t[0] * t[2] + t[1] * t[1],
                                   2.0 * t[1] * t[2], t[2] * t[2]};
    std::array<double, 11> p{};
    for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t j = 0; j < 6; ++j) p[i + j] += d[i] * d[j];
    }
    for (std::size_t i = 0; i < 7; ++i) {
        const double x = kSix[i] * b.disc[i];
        for (std::size_t j = 0; j < 5; ++j) p[i + j] -= x * tt[j];
    }
    // d is wrong by 2 roundings of disc, and so on; 16 u are for the sums.
    const double disc = std::max(b.disc_most, -b.disc_least);
    const double noise = b.rounding * (4.0 * d_most + t_most * t_most) +
                         16.0 * kUnitRoundoff * (d_most * d_most + t_most * t_most * disc) +
                         8.0 * kUnitRoundoff * t_most * disc;
    int changes = 0;
    bool positive = p[0] > 0.0;
    for (std::size_t i = 0; i < 11; ++i) {
        if (!(std::fabs(p[i]) > noise * kTen[i])) return false;
        changes += (p[i] > 0.0) != positive ? 1 : 0;
        positive = p[i] > 0.0;
    }
    return changes <= 1;
}

}  // namespace raymo::solids
