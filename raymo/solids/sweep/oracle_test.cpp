// Sweeps against the union of many balls: samples of the path in extended precision, refined where they are largest. It
// shares nothing with the kernel but the definition.
#include <doctest/doctest.h>

#include <algorithm>

#include "raymo/solids/conformance.hpp"
#include "raymo/solids/sweep/test_paths.hpp"

namespace raymo::solids {
namespace {

using namespace test;
using conformance::Random;
using Real = long double;

/// Samples of a span; and where the spans that are found are others, as two extrema may lie between two samples.
constexpr int kSamples = 64, kManySamples = 4096;

struct Interval {
    Real lo, hi;
    Real lo_error = 0, hi_error = 0;
};

/// Half the chord of one ball, squared, and where its middle is.
struct Chorded {
    Real middle, half2;
};

class Oracle {
public:
    Oracle(const SweptSpan& span, Vec3 o, Vec3 d) : q_(span.cubics) {
        const Real length = std::sqrt(static_cast<Real>(d.x) * d.x + static_cast<Real>(d.y) * d.y +
                                      static_cast<Real>(d.z) * d.z);
        for (int k = 0; k < 3; ++k) {
            o_[k] = o[k];
            d_[k] = d[k] / length;
        }
    }

    [[nodiscard]] Chorded at(Real u) const {
        const Real v = 1 - u;
        const Real w[4] = {v * v * v, 3 * v * v * u, 3 * v * u * u, u * u * u};
        Real c[4] = {};
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t k = 0; k < 4; ++k) c[k] += w[i] * static_cast<Real>(q_.c[i][k]);
        }
        Real middle = 0;
        for (int k = 0; k < 3; ++k) middle += (c[k] - o_[k]) * d_[k];
        Real beside = 0;
        for (int k = 0; k < 3; ++k) {
            const Real x = c[k] - o_[k] - middle * d_[k];
            beside += x * x;
        }
        return {middle, c[3] * c[3] - beside};
    }

    /// Adds the intervals of all balls.
    void add(int count, std::vector<Interval>& out) const {
        const auto place = [&](int i) { return static_cast<Real>(i) / count; };
        // Samples, and between them where balls are met the most and the least.
        std::vector<Real> places;
        std::vector<Real> half2;
        const auto take = [&](Real u) {
            places.push_back(u);
            half2.push_back(at(u).half2);
        };
        const auto slope = [&](Real u) {
            constexpr Real kStep = 1e-7L;
            return at(u + kStep).half2 - at(u - kStep).half2;
        };
        take(0);
        Real slope_before = slope(0);
        for (int i = 1; i <= count; ++i) {
            const Real slope_after = slope(place(i));
            if ((slope_before > 0) != (slope_after > 0)) {
                const Real sign = slope_before > 0 ? 1 : -1;
                take(largest(place(i - 1), place(i), [&](Real u) { return sign * at(u).half2; }));
            }
            take(place(i));
            slope_before = slope_after;
        }
        // Runs of balls that are met.
        for (std::size_t i = 0; i < places.size(); ++i) {
            if (half2[i] < 0) continue;
            std::size_t last = i;
            while (last + 1 < places.size() && half2[last + 1] >= 0) ++last;
            out.push_back(run(places, i, last));
            i = last;
        }
    }

private:
    static Real none() { return -1e30L; }
    /// sign middle + half, or very little.
    [[nodiscard]] Real reach(Real u, Real sign) const {
        const Chorded c = at(u);
        return c.half2 >= 0 ? sign * c.middle + std::sqrt(c.half2) : none();
    }
    /// Where f is largest, by golden sections.
    template <class F>
    static Real largest(Real lo, Real hi, const F& f) {
        constexpr Real kGolden = 0.61803398874989484820L;
        Real a = hi - kGolden * (hi - lo);
        Real b = lo + kGolden * (hi - lo);
        Real fa = f(a);
        Real fb = f(b);
        for (int i = 0; i < 60; ++i) {
            if (fa > fb) {
                hi = b;
                b = a;
                fb = fa;
                a = hi - kGolden * (hi - lo);
                fa = f(a);
            } else {
                lo = a;
                a = b;
                fa = fb;
                b = lo + kGolden * (hi - lo);
                fb = f(b);
            }
        }
        return (lo + hi) / 2;
    }
    /// Where the balls between a ball that is met, at `in`, and one that is not begin to be met.
    [[nodiscard]] Real border(Real in, Real out) const {
        for (int i = 0; i < 70; ++i) {
            const Real u = (in + out) / 2;
            (at(u).half2 >= 0 ? in : out) = u;
        }
        return in;
    }
    /// The interval of balls first to last of `all`, and those up to where they are no longer met.
    [[nodiscard]] Interval run(const std::vector<Real>& all, std::size_t first,
                               std::size_t last) const {
        std::vector<Real> places(all.begin() + static_cast<std::ptrdiff_t>(first),
                                 all.begin() + static_cast<std::ptrdiff_t>(last) + 1);
        if (first > 0) places.insert(places.begin(), border(all[first], all[first - 1]));
        if (last + 1 < all.size()) places.push_back(border(all[last], all[last + 1]));
        Interval out{};
        for (const Real sign : {Real(-1), Real(1)}) {
            Real best = none();
            for (std::size_t i = 0; i < places.size(); ++i) {
                const Real here = reach(places[i], sign);
                best = std::max(best, here);
                const Real before = i > 0 ? reach(places[i - 1], sign) : none();
                const Real after = i + 1 < places.size() ? reach(places[i + 1], sign) : none();
                if (here < before || here < after) continue;
                const Real u =
                    largest(places[i > 0 ? i - 1 : i], places[i + 1 < places.size() ? i + 1 : i],
                            [&](Real x) { return reach(x, sign); });
                best = std::max(best, reach(u, sign));
            }
            (sign < 0 ? out.lo : out.hi) = sign * best;
        }
        return out;
    }

    Cubics q_;
    Real o_[3], d_[3];
};

/// Ascending and disjoint; what is thinner than `least` is left out, spans and gaps.
std::vector<Interval> united(std::vector<Interval> all, Real least) {
    std::sort(all.begin(), all.end(),
              [](const Interval& a, const Interval& b) { return a.lo < b.lo; });
    std::vector<Interval> joined;
    for (const Interval& i : all) {
        if (!joined.empty() && i.lo - joined.back().hi < least) {
            if (i.hi > joined.back().hi) {
                joined.back().hi = i.hi;
                joined.back().hi_error = i.hi_error;
            }
        } else {
            joined.push_back(i);
        }
    }
    std::erase_if(joined, [&](const Interval& i) { return i.hi - i.lo < least; });
    return joined;
}

/// A line at a sweep: any, along an axis, through joints and poles, tangent, along the path.
void aim(const Sweep::Kernel& kernel, Random& random, Vec3& o, Vec3& d) {
    const auto& spans = kernel.spheres().spans;
    const Cubics& q =
        spans[static_cast<std::size_t>(random.below(static_cast<int>(spans.size())))].cubics;
    const double u = random.chance(0.3) ? random.below(2) : random.uniform(0, 1);
    const CubicsJet j = jet_at(q, u);
    const Vec3 centre{j.value[0], j.value[1], j.value[2]};
    const Vec3 tangent{j.first[0], j.first[1], j.first[2]};
    d = random.direction();
    o = centre;
    switch (random.below(7)) {
        case 0:
            o = random.in_cube(1);
            break;
        case 1:
            d = Vec3{};
            d[random.below(3)] = 1;
            o += random.in_cube(j.value[3]);
            break;
        case 2:
            break;
        case 3:  // through the pole of a ball
            if (max_norm(tangent) > 1e-6) o += unit(tangent) * j.value[3];
            break;
        case 4:  // along the path
            if (max_norm(tangent) > 1e-6) d = unit(tangent);
            o += random.in_cube(random.small(30) * j.value[3]);
            break;
        case 5: {  // tangent, and nearly
            const Vec3 n = max_norm(tangent) > 1e-6 ? unit(cross(tangent, random.direction()))
                                                    : random.direction();
            o += n * (j.value[3] * (1 + random.small(20) * random.uniform(-1, 1)));
            d = unit(cross(n, random.direction()));
            break;
        }
        default:
            o += random.in_cube(j.value[3]);
    }
    o -= d * (dot(o, d) / dot(d, d));
}

TEST_CASE("sweep: spans end where those of a union of balls do") {
    constexpr int kRays = 110000;
    constexpr Real kThin = 1e-5L;
    Random random(44);
    int asked = 0, met = 0, unequal = 0, off = 0, blurred = 0, degenerate = 0;
    const auto examples = Sweep::examples();
    while (asked < kRays) {
        // Every example without flat ends, and paths of any shape.
        curves::Path path;
        if (random.chance(0.5)) {
            const auto& example =
                examples[static_cast<std::size_t>(random.below(static_cast<int>(examples.size())))];
            path = *std::get<curves::PathPtr>(example[0]);
            if (path.spans.size() > 8) continue;
        } else {
            std::vector<Ball> points;
            const int n = 4 + random.below(4);
            const double radius = std::ldexp(1.0, -random.below(8));
            for (int i = 0; i < n; ++i) {
                points.push_back({random.in_cube(1),
                                  radius * (random.chance(0.5) ? 1.0 : random.uniform(0, 2))});
                if (random.chance(0.2)) points.push_back(points.back());
            }
            path = b_spline(points, random.chance(0.3));
        }
        const Asked sweep(path);
        const auto& spheres = sweep.kernel().spheres();
        for (int i = 0; i < 200; ++i, ++asked) {
            Vec3 o, d;
            aim(sweep.kernel(), random, o, d);
            const double e = 0x1p-50;
            SpanList list;
            sweep.kernel().spans(
                {o.x, o.y, o.z, d.x, d.y, d.z, e, e, e, dot(d, d), kFromTheBeginning}, list);
            if (list.degenerate()) {
                ++degenerate;
                continue;
            }
            std::vector<Interval> found;
            const Real length = norm(d);
            for (std::size_t k = 0; k < list.size(); ++k) {
                const Span& span = list[k];
                found.push_back({span.enter.s * length, span.exit.s * length,
                                 span.enter.error * length, span.exit.error * length});
            }
            found = united(std::move(found), kThin);
            std::vector<Interval> truth;
            for (const int samples : {kSamples, kManySamples}) {
                std::vector<Interval> balls;
                for (const SweptSpan& span : spheres.spans) Oracle(span, o, d).add(samples, balls);
                truth = united(std::move(balls), kThin);
                if (truth.size() == found.size()) break;
            }
            met += static_cast<int>(truth.size());
            if (found.size() != truth.size()) {
                ++unequal;
                continue;
            }
            for (std::size_t k = 0; k < truth.size(); ++k) {
                const Interval& f = found[k];
                if (std::fabs(f.lo - truth[k].lo) > 1e-9L + f.lo_error) ++off;
                if (std::fabs(f.hi - truth[k].hi) > 1e-9L + f.hi_error) ++off;
                // Where the line touches, and the ball's place on the path with it, an end is less certain.
                if (std::max(f.lo_error, f.hi_error) > 1e-9L) ++blurred;
            }
        }
    }
    CHECK(met > asked / 2);
    CHECK(unequal == 0);
    CHECK(off == 0);
    CHECK(blurred < asked / 100);
    CHECK(degenerate < asked / 100);
}

}  // namespace
}  // namespace raymo::solids
