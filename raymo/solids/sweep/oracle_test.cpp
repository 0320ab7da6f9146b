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

constexpr int kSamples = 160;

struct Interval {
    Real lo, hi;
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
    void add(std::vector<Interval>& out) const {
        std::vector<Chorded> samples(kSamples + 1);
        for (int i = 0; i <= kSamples; ++i) samples[static_cast<std::size_t>(i)] = at(place(i));
        const auto half2 = [&](int i) { return samples[static_cast<std::size_t>(i)].half2; };
        // Runs of balls that are met; a run may lie between two samples.
        for (int i = 0; i <= kSamples; ++i) {
            if (half2(i) >= 0) {
                int last = i;
                while (last < kSamples && half2(last + 1) >= 0) ++last;
                out.push_back(run(i, last));
                i = last;
            } else if (i > 0 && i < kSamples && half2(i) >= half2(i - 1) &&
                       half2(i) >= half2(i + 1)) {
                const Real u =
                    largest(place(i - 1), place(i + 1), [&](Real x) { return at(x).half2; });
                if (at(u).half2 > 0 && half2(i - 1) < 0 && half2(i + 1) < 0)
                    out.push_back(around(u, place(i - 1), place(i + 1)));
            }
        }
    }

private:
    static Real place(int i) { return static_cast<Real>(i) / kSamples; }
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
    [[nodiscard]] Interval around(Real u, Real before, Real after) const {
        const Real first = border(u, before);
        const Real last = border(u, after);
        Interval out{};
        for (const Real sign : {Real(-1), Real(1)}) {
            const Real best = largest(first, last, [&](Real x) { return reach(x, sign); });
            (sign < 0 ? out.lo : out.hi) = sign * std::max(reach(best, sign), reach(u, sign));
        }
        return out;
    }
    [[nodiscard]] Interval run(int first, int last) const {
        const Real begin = first > 0 ? border(place(first), place(first - 1)) : 0;
        const Real end = last < kSamples ? border(place(last), place(last + 1)) : 1;
        std::vector<Real> places{begin};
        for (int i = first; i <= last; ++i) places.push_back(place(i));
        places.push_back(end);
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
            joined.back().hi = std::max(joined.back().hi, i.hi);
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
    int asked = 0, met = 0, unequal = 0, off = 0, degenerate = 0;
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
            sweep.kernel().spans({o.x, o.y, o.z, d.x, d.y, d.z, e, e, e, dot(d, d)}, list);
            if (list.degenerate()) {
                ++degenerate;
                continue;
            }
            std::vector<Interval> balls;
            for (const SweptSpan& span : spheres.spans) Oracle(span, o, d).add(balls);
            const std::vector<Interval> truth = united(std::move(balls), kThin);
            std::vector<Interval> found;
            const Real length = norm(d);
            for (std::size_t k = 0; k < list.size(); ++k)
                found.push_back({list[k].enter.s * length, list[k].exit.s * length});
            found = united(std::move(found), kThin);
            met += static_cast<int>(truth.size());
            if (found.size() != truth.size()) {
                ++unequal;
                continue;
            }
            for (std::size_t k = 0; k < truth.size(); ++k) {
                if (std::fabs(found[k].lo - truth[k].lo) > 1e-9L ||
                    std::fabs(found[k].hi - truth[k].hi) > 1e-9L)
                    ++off;
            }
        }
    }
    CHECK(met > asked / 2);
    CHECK(unequal == 0);
    CHECK(off == 0);
    CHECK(degenerate < asked / 100);
    MESSAGE(asked, " lines, ", met, " spans, ", degenerate, " degenerate, ", unequal, " unequal, ",
            off, " off");
}

}  // namespace
}  // namespace raymo::solids
