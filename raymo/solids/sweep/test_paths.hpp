// Paths for the tests of sweeps.
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "raymo/solids/sweep/sweep.hpp"

namespace raymo::solids::test {

struct Ball {
    Vec3 p;
    double r;
};

inline curves::PathSpan bezier(const Ball& a, const Ball& b, const Ball& c, const Ball& d) {
    return {{a.p.x, b.p.x, c.p.x, d.p.x},
            {a.p.y, b.p.y, c.p.y, d.p.y},
            {a.p.z, b.p.z, c.p.z, d.p.z},
            {a.r, b.r, c.r, d.r}};
}
inline Ball between(const Ball& a, const Ball& b, double t) {
    return {a.p * (1.0 - t) + b.p * t, a.r * (1.0 - t) + b.r * t};
}
inline curves::PathSpan straight(const Ball& a, const Ball& b) {
    return bezier(a, between(a, b, 1.0 / 3.0), between(a, b, 2.0 / 3.0), b);
}
/// The cubic with these coefficients of 1, u, u^2, u^3.
inline curves::PathSpan of_powers(const Ball (&k)[4]) {
    const Ball& a = k[0];
    const Ball b{a.p + k[1].p / 3.0, a.r + k[1].r / 3.0};
    const Ball c{a.p + k[1].p * (2.0 / 3.0) + k[2].p / 3.0,
                 a.r + k[1].r * (2.0 / 3.0) + k[2].r / 3.0};
    return bezier(a, b, c, {a.p + k[1].p + k[2].p + k[3].p, a.r + k[1].r + k[2].r + k[3].r});
}
/// A uniform cubic B-spline; `closed`: round in a ring.
inline curves::Path b_spline(const std::vector<Ball>& points, bool closed) {
    curves::Path out;
    out.closed = closed;
    const std::size_t n = points.size();
    for (std::size_t i = 0; i < (closed ? n : n - 3); ++i) {
        const Ball& a = points[i];
        const Ball& b = points[(i + 1) % n];
        const Ball& c = points[(i + 2) % n];
        const Ball& d = points[(i + 3) % n];
        out.spans.push_back(
            bezier(between(between(a, b, 2.0 / 3.0), between(b, c, 1.0 / 3.0), 0.5),
                   between(b, c, 1.0 / 3.0), between(b, c, 2.0 / 3.0),
                   between(between(b, c, 2.0 / 3.0), between(c, d, 1.0 / 3.0), 0.5)));
    }
    return out;
}

inline std::vector<Argument> arguments(curves::Path path, bool flat = false) {
    return {std::make_shared<const curves::Path>(std::move(path)), std::size_t{flat ? 1U : 0U}};
}

/// A sweep that is asked in the user's frame.
class Asked {
public:
    explicit Asked(curves::Path path, bool flat = false)
        : placed_(Sweep::prepare(arguments(std::move(path), flat)).value()) {}

    [[nodiscard]] const Sweep::Kernel& kernel() const { return placed_.kernel; }
    [[nodiscard]] double unit() const { return placed_.to_object.linear.row[0].x; }
    /// Spans of o + t d, in t.
    [[nodiscard]] std::vector<Span> spans(Vec3 o, Vec3 d) const {
        const Vec3 at = (o - placed_.to_object.offset) / unit();
        const double shift = -dot(at, d) / dot(d, d);
        const Vec3 near = at + d * shift;
        const double e = 0x1p-50;
        SpanList list;
        placed_.kernel.spans(
            {near.x, near.y, near.z, d.x, d.y, d.z, e, e, e, dot(d, d), kFromTheBeginning}, list);
        std::vector<Span> out;
        for (std::size_t i = 0; i < list.size(); ++i) {
            Span span = list[i];
            for (SpanEnd* end : {&span.enter, &span.exit}) {
                end->s = (end->s + shift) * unit();
                end->error *= unit();
            }
            out.push_back(span);
        }
        return out;
    }
    [[nodiscard]] Vec3 normal(Vec3 p, std::uint16_t face) const {
        return raymo::unit(placed_.kernel.normal((p - placed_.to_object.offset) / unit(), face));
    }
    [[nodiscard]] Where where(Vec3 p) const {
        return placed_.kernel.where((p - placed_.to_object.offset) / unit(), {});
    }
    /// By cells x cells parallel lines along `d`, a unit vector.
    [[nodiscard]] double volume(Vec3 d, int cells) const {
        Vec3 s, t;
        make_frame(d, s, t);
        const double r = 1.8 * unit();
        double sum = 0.0;
        for (int i = 0; i < cells; ++i) {
            for (int j = 0; j < cells; ++j) {
                const Vec3 o = placed_.to_object.offset +
                               s * (r * ((2.0 * i + 1.0) / cells - 1.0)) +
                               t * (r * ((2.0 * j + 1.0) / cells - 1.0));
                for (const Span& span : spans(o, d)) sum += span.exit.s - span.enter.s;
            }
        }
        return sum * 4.0 * r * r / (static_cast<double>(cells) * cells);
    }

private:
    Placed<Sweep::Kernel> placed_;
};

}  // namespace raymo::solids::test
