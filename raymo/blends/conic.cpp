#include "raymo/blends/conic.hpp"

#include <cmath>

#include "raymo/core/assert.hpp"

namespace raymo::blends {
namespace {

/// Cubics with the right tangents at so many places are within (1 / 256)^4 / 384 of the fourth derivative.
constexpr int kSpans = 256;

/// The function g of a surface, natural side up.
class Level {
public:
    explicit Level(const SectionCurve& c) : radius_(c.is_line ? c.round : c.radius) {}

    [[nodiscard]] bool is_linear() const { return radius_ == 0.0; }
    [[nodiscard]] double at(double distance) const {
        return is_linear() ? distance : distance * (2.0 * radius_ + distance);
    }
    [[nodiscard]] double distance(double level) const {
        if (is_linear()) return level;
        // sqrt(R^2 + level) - R without cancellation.
        return level / (std::sqrt(std::max(radius_ * radius_ + level, 0.0)) + radius_);
    }

private:
    double radius_;
};

class Conic {
public:
    Conic(const EdgeCurve& e, const Wedge& w, double weight)
        : edge_(e),
          a_(e.a),
          b_(e.b),
          range_a_(a_.at(e.a.side * e.a.distance(w.contact[1]))),
          range_b_(b_.at(e.b.side * e.b.distance(w.contact[0]))),
          weight_(weight) {}

    [[nodiscard]] bool is_linear() const {
        return a_.is_linear() && b_.is_linear() && !edge_.a.run && !edge_.b.run;
    }

    /// From contact 1 (0) to contact 0 (1), and a little beyond both.
    [[nodiscard]] Vec2 at(double t) const {
        const double s = 1.0 - t;
        const double d = s * s + 2.0 * weight_ * s * t + t * t;
        const double from_a = edge_.a.side * a_.distance(range_a_ * s * s / d);
        const double from_b = edge_.b.side * b_.distance(range_b_ * t * t / d);
        const auto p = edge_.at_distances(from_a, from_b);
        RAYMO_ASSERT(p.has_value());
        return *p;
    }
    /// Its derivative, from four neighbours: to h^4.
    [[nodiscard]] Vec2 derivative(double t) const {
        constexpr double h = 0x1p-10;
        return (8.0 * (at(t + h) - at(t - h)) - (at(t + 2.0 * h) - at(t - 2.0 * h))) *
               (1.0 / (12.0 * h));
    }

private:
    const EdgeCurve& edge_;
    Level a_, b_;
    double range_a_, range_b_;
    double weight_;
};

}  // namespace

void append_conic(curves::Curve& curve, const Segment& segment, const Wedge& wedge, double shape) {
    const EdgeCurve& e = segment.edge;
    const double weight = std::sqrt(0.5 * (1.0 - shape));
    const Conic conic(e, wedge, weight);
    if (conic.is_linear()) {
        curve.spans.push_back(conic_arc(wedge.contact[1], e.at, wedge.contact[0], weight));
        return;
    }
    Vec2 from = wedge.contact[1];
    Vec2 from_way = conic.derivative(0.0);
    for (int i = 1; i <= kSpans; ++i) {
        const double t = static_cast<double>(i) / kSpans;
        const Vec2 to = i == kSpans ? wedge.contact[0] : conic.at(t);
        const Vec2 to_way = conic.derivative(t);
        const double third = 1.0 / (3.0 * kSpans);
        curve.spans.push_back(
            curves::cubic(from, from + from_way * third, to - to_way * third, to));
        from = to;
        from_way = to_way;
    }
}

}  // namespace raymo::blends
