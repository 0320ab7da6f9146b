#include "raymo/blends/conic.hpp"

#include <cmath>

#include "raymo/blends/fit.hpp"
#include "raymo/core/assert.hpp"

namespace raymo::blends {
namespace {

/// How far cubics may be off, as part of the distance from contact to contact; and at most so many halvings, and cubics.
constexpr double kTolerance = 1e-10;
constexpr int kMostHalvings = 40;
constexpr std::size_t kMostSpans = 1024;

Level level_of(const SectionCurve& c) { return Level(c.is_line ? c.round : c.radius); }

class Conic {
public:
    Conic(const EdgeCurve& e, const Wedge& w, double shape)
        : edge_(e),
          distances_(level_of(e.a), e.a.side * e.a.distance(w.contact[1]), level_of(e.b),
                     e.b.side * e.b.distance(w.contact[0]), shape) {}

    [[nodiscard]] bool is_linear() const {
        return level_of(edge_.a).is_linear() && level_of(edge_.b).is_linear() && !edge_.a.run &&
               !edge_.b.run;
    }

    /// From contact 1 (0) to contact 0 (1).
    [[nodiscard]] Vec2 at(double t) const {
        const ConicDistances::Pair from = distances_.at(t);
        const auto p = edge_.at_distances(edge_.a.side * from.a, edge_.b.side * from.b);
        RAYMO_ASSERT(p.has_value());
        return *p;
    }
    /// The parameter at a part of a stretch, as of a conic.
    [[nodiscard]] double part(double from, double to, double v) const {
        return distances_.part(from, to, v);
    }

private:
    const EdgeCurve& edge_;
    ConicDistances distances_;
};

}  // namespace

double Level::distance(double level) const {
    if (is_linear()) return level;
    // sqrt(R^2 + level) - R without cancellation.
    return level / (std::sqrt(std::max(radius_ * radius_ + level, 0.0)) + radius_);
}

Level level_of(const Surface& surface) {
    switch (surface.kind) {
        case SurfaceKind::sphere:
        case SurfaceKind::cylinder:
            return Level(surface.radius);
        case SurfaceKind::torus:
            return Level(surface.tube);
        case SurfaceKind::plane:
        case SurfaceKind::cone:
        case SurfaceKind::wall:
        case SurfaceKind::turned:
        case SurfaceKind::leaning:
            break;
    }
    return Level(0.0);
}

ConicDistances::ConicDistances(Level a, double reach_a, Level b, double reach_b, double shape)
    : a_(a),
      b_(b),
      range_a_(a.at(reach_a)),
      range_b_(b.at(reach_b)),
      weight_(std::sqrt(0.5 * (1.0 - shape))) {}

ConicDistances::Pair ConicDistances::at(double t) const {
    const double s = 1.0 - t;
    const double d = weight_at(t);
    return {a_.distance(range_a_ * s * s / d), b_.distance(range_b_ * t * t / d)};
}

double ConicDistances::part(double from, double to, double v) const {
    const double left = std::sqrt(weight_at(to)) * (1.0 - v);
    const double right = std::sqrt(weight_at(from)) * v;
    return (from * left + to * right) / (left + right);
}

void append_conic(curves::Curve& curve, const Segment& segment, const Wedge& wedge, double shape) {
    const EdgeCurve& e = segment.edge;
    const Conic conic(e, wedge, shape);
    if (conic.is_linear()) {
        const double weight = std::sqrt(0.5 * (1.0 - shape));
        curve.spans.push_back(conic_arc(wedge.contact[1], e.at, wedge.contact[0], weight));
        return;
    }
    // In a plane of space; both contacts to the last bits.
    const auto place = [&](double t) {
        const Vec2 p = t == 0.0 ? wedge.contact[1] : (t == 1.0 ? wedge.contact[0] : conic.at(t));
        return Vec3{p.x, p.y, 0.0};
    };
    const double allowed = kTolerance * norm(wedge.contact[1] - wedge.contact[0]);
    struct Stretch {
        double from, to;
        int halvings;
    };
    std::vector<Stretch> open{{0.0, 1.0, 0}};
    for (std::size_t count = 0; !open.empty();) {
        const auto [from, to, halvings] = open.back();
        open.pop_back();
        Places met;
        for (std::size_t k = 0; k < met.size(); ++k)
            met[k] = place(k + 1 == met.size() ? to : conic.part(from, to, kPlaces[k]));
        const Vec3 up{0.0, 0.0, norm(met.back() - met.front())};
        const Cubic c = cubic_through(local_line(met, up));
        bool is_near = true;
        for (const double v : kBetween) {
            const auto offset = local_cubic(c, up, v).offset(place(conic.part(from, to, v)));
            is_near &= std::fabs(offset.off) <= allowed && std::fabs(offset.u) <= kSlide;
        }
        if (is_near || halvings == kMostHalvings || count + open.size() >= kMostSpans) {
            const auto flat = [](Vec3 p) { return Vec2{p.x, p.y}; };
            curve.spans.push_back(curves::cubic(flat(c[0]), flat(c[1]), flat(c[2]), flat(c[3])));
            ++count;
            continue;
        }
        const double middle = conic.part(from, to, 0.5);
        open.push_back({middle, to, halvings + 1});
        open.push_back({from, middle, halvings + 1});
    }
}

}  // namespace raymo::blends
