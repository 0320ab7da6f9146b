// Fits cubics to a function: each takes the values and the derivatives of f at its ends (Hermite), and the interval is halved
// until the cubic is near enough. The error of a cubic on an interval of length h is f'''' h^4 / 384.
//
// Derivatives come from central differences over five values a step d apart, error d^4 f''''' / 30, and at the ends of the
// whole interval from one side, error d^4 f''''' / 5. d is a power of two, so that the steps are exact, and 2^-16 of the
// interval: rounding then costs about 2^-53 |f| / d in the derivative, which moves the cubic by 2^-40 |f| at most.
#include <algorithm>
#include <cmath>
#include <string>

#include "raymo/curves/build_errors.hpp"
#include "raymo/curves/build_path.hpp"
#include "raymo/math/tolerance.hpp"

namespace raymo::curves {
namespace {

constexpr std::size_t kMostFitted = 100000;
constexpr int kMostHalvings = 44;
constexpr int kFirstSpans = 8;
constexpr int kChecks = 10;  ///< each span is looked at 1/10, 2/10, ..., 9/10 of its way

struct Knot {
    double t = 0.0;
    Point<4> value{};
    Point<4> derivative{};
};

class Fitter {
public:
    Fitter(const PathFunction& f, double low, double high, double tolerance)
        : f_(f), low_(low), high_(high), tolerance_(tolerance) {
        const double size = std::max(std::fabs(low), std::fabs(high));
        step_ = std::ldexp(1.0, std::max(std::ilogb(high - low) - 16, std::ilogb(size) - 50));
    }

    Result<std::vector<SplineSpan<4>>> run() {
        struct Interval {
            Knot begin, end;
            int halvings;
        };
        std::vector<Interval> open;
        std::vector<Knot> knots(kFirstSpans + 1);
        for (int i = 0; i <= kFirstSpans; ++i) {
            const double part = static_cast<double>(i) / kFirstSpans;
            const double t = i == kFirstSpans ? high_ : low_ + (high_ - low_) * part;
            if (auto made = set(knots[static_cast<std::size_t>(i)], t); !made)
                return Failure(std::move(made).error());
        }
        join_ends(knots.front(), knots.back());
        for (std::size_t i = kFirstSpans; i-- > 0;) open.push_back({knots[i], knots[i + 1], 0});
        std::vector<SplineSpan<4>> spans;
        while (!open.empty()) {
            const Interval at = open.back();
            open.pop_back();
            const SplineSpan<4> span = cubic(at.begin, at.end);
            auto good = is_near(span, at.begin.t, at.end.t);
            if (!good) return Failure(std::move(good).error());
            if (*good) {
                spans.push_back(span);
                continue;
            }
            Knot middle;
            const double t = at.begin.t + 0.5 * (at.end.t - at.begin.t);
            if (at.halvings >= kMostHalvings || !(t > at.begin.t && t < at.end.t)) {
                return wrong(0, "the function jumps, or varies by less than the tolerance can see",
                             "it must be continuous; a larger `tolerance` may help",
                             "this happens at " + shown(at.begin.t));
            }
            if (spans.size() + open.size() >= kMostFitted) {
                return wrong(2, "this tolerance takes more than 100000 spans",
                             "give a larger tolerance or a shorter range",
                             "this is " + shown(tolerance_));
            }
            if (auto made = set(middle, t); !made) return Failure(std::move(made).error());
            open.push_back({middle, at.end, at.halvings + 1});
            open.push_back({at.begin, middle, at.halvings + 1});
        }
        return spans;
    }

private:
    Result<Point<4>> value(double t) const {
        auto p = f_(t);
        if (!p) return p;
        for (const double x : *p) {
            if (!(std::fabs(x) <= kLargestCoordinate))
                return wrong(0, "the function's values are too large to be computed with",
                             "stay within 1e90 of the origin",
                             "it gives " + shown(x) + " at " + shown(t));
        }
        if (!((*p)[3] >= 0.0))
            return wrong(0, "the radius must be at least 0", {},
                         "it gives " + shown((*p)[3]) + " at " + shown(t));
        return p;
    }

    Result<void> set(Knot& knot, double t) const {
        knot.t = t;
        auto at = value(t);
        if (!at) return Failure(std::move(at).error());
        knot.value = *at;
        // sum of weight[j] f(t + place[j] d), over 12 d
        struct Stencil {
            std::array<double, 5> place, weight;
        };
        static constexpr Stencil kCentral{{-2, -1, 0, 1, 2}, {1, -8, 0, 8, -1}};
        static constexpr Stencil kForward{{0, 1, 2, 3, 4}, {-25, 48, -36, 16, -3}};
        static constexpr Stencil kBackward{{-4, -3, -2, -1, 0}, {3, -16, 36, -48, 25}};
        const Stencil& s = t - 2.0 * step_ < low_    ? kForward
                           : t + 2.0 * step_ > high_ ? kBackward
                                                     : kCentral;
        knot.derivative = {};
        for (std::size_t j = 0; j < 5; ++j) {
            if (s.weight[j] == 0.0) continue;
            auto p = s.place[j] == 0.0 ? at : value(t + s.place[j] * step_);
            if (!p) return Failure(std::move(p).error());
            for (std::size_t k = 0; k < 4; ++k)
                knot.derivative[k] += s.weight[j] * ((*p)[k] - knot.value[k]);
        }
        for (double& d : knot.derivative) d /= 12.0 * step_;
        return {};
    }

    /// Ends that differ by the rounding of f alone are made one.
    static void join_ends(const Knot& first, Knot& last) {
        double size = 0.0;
        double gap = 0.0;
        for (std::size_t k = 0; k < 4; ++k) {
            size = std::max(size, std::fabs(first.value[k]));
            gap = std::max(gap, std::fabs(first.value[k] - last.value[k]));
        }
        if (gap <= 64.0 * kUnitRoundoff * size) last.value = first.value;
    }

    static SplineSpan<4> cubic(const Knot& a, const Knot& b) {
        const double third = (b.t - a.t) / 3.0;
        SplineSpan<4> s{a.value, a.value, b.value, b.value};
        for (std::size_t k = 0; k < 4; ++k) {
            s[1][k] += third * a.derivative[k];
            s[2][k] -= third * b.derivative[k];
        }
        return s;
    }

    Result<bool> is_near(const SplineSpan<4>& s, double begin, double end) const {
        for (int i = 1; i < kChecks; ++i) {
            const double u = static_cast<double>(i) / kChecks;
            const double v = 1.0 - u;
            auto p = value(begin + u * (end - begin));
            if (!p) return Failure(std::move(p).error());
            Point<4> gap{};
            for (std::size_t k = 0; k < 4; ++k) {
                gap[k] = (v * v * v * s[0][k] + 3.0 * u * v * v * s[1][k]) +
                         (3.0 * u * u * v * s[2][k] + u * u * u * s[3][k]) - (*p)[k];
            }
            if (!(std::hypot(gap[0], gap[1], gap[2]) <= tolerance_) ||
                !(std::fabs(gap[3]) <= tolerance_)) {
                return false;
            }
        }
        return true;
    }

    const PathFunction& f_;
    double low_, high_, tolerance_, step_;
};

}  // namespace

Result<BuiltPath> fit_path(const PathFunction& f, double low, double high, double tolerance) {
    if (!(tolerance > 0.0) || !std::isfinite(tolerance))
        return wrong(2, "the tolerance must be greater than 0", {}, "this is " + shown(tolerance));
    const double size = std::max(std::fabs(low), std::fabs(high));
    // The steps of the differences, 2^-50 of the size at least, must be small within the interval.
    if (!(high - low > 0x1p-40 * size) || !(size <= kLargestCoordinate))
        return wrong(1, "the range must go up, and be no shorter than its numbers can tell", {},
                     "this is " + shown(low) + " to " + shown(high));
    auto spans = Fitter(f, low, high, tolerance).run();
    if (!spans) return Failure(std::move(spans).error());
    return path_of(*spans);
}

}  // namespace raymo::curves
