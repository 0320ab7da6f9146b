#include "raymo/blends/profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "raymo/curves/bernstein.hpp"

namespace raymo::blends {
namespace {

constexpr int kSamples = 8;  // for each span

/// How far the straight continuations of a run are looked at for crossings, as part of its size: a corner with what goes on
/// is at the very end, on one side of it or the other.
constexpr double kBeyondEnds = 0x1p-6;
/// An interval between two samples is halved so often, looking for crossings.
constexpr int kMostHalvings = 6;
/// Cubics with the right tangents at n places of a span are within n^-4 / 384 of the fourth derivative, which polynomial spans
/// have none of; what they are moved by turns with them.
constexpr int kPolynomialParts = 8;
constexpr int kRationalParts = 32;

/// A cubic and its two derivatives.
struct Cubic {
    double value, first, second;
};
Cubic cubic_at(const std::array<double, 4>& c, double u) {
    const auto d = curves::derivative(c);
    const auto dd = curves::derivative(d);
    return {curves::value_at(c, u), curves::value_at(d, u), curves::value_at(dd, u)};
}

}  // namespace

Run::Run(std::vector<curves::Span2> spans, bool is_closed)
    : spans_(std::move(spans)), is_closed_(is_closed) {
    for (std::size_t i = 0; i < spans_.size(); ++i) {
        for (int k = 0; k < kSamples; ++k) {
            samples_.push_back(
                jet(static_cast<double>(i) + static_cast<double>(k) / kSamples).value);
        }
    }
    if (!is_closed_) samples_.push_back(jet(end()).value);
    Vec2 lo = samples_[0];
    Vec2 hi = lo;
    grain_ = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < samples_.size(); ++i) {
        const Vec2 p = samples_[i];
        lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
        hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
        if (p != samples_[i - 1]) grain_ = std::min(grain_, norm(p - samples_[i - 1]));
    }
    size_ = 0.5 * norm(hi - lo);
}

Run::Jet Run::jet(double u) const {
    const double last = end() - 1.0;
    double whole = std::floor(u);
    if (is_closed_) {
        u -= end() * std::floor(u / end());
        whole = std::floor(u);
    }
    whole = std::clamp(whole, 0.0, last);
    const curves::Span2& s = spans_[static_cast<std::size_t>(whole)];
    const double f = u - whole;
    const Cubic x = cubic_at(s.x, f);
    const Cubic y = cubic_at(s.y, f);
    const Cubic w = cubic_at(s.w, f);
    const Vec2 p{x.value / w.value, y.value / w.value};
    const Vec2 d{(x.first - p.x * w.first) / w.value, (y.first - p.y * w.first) / w.value};
    const Vec2 dd{(x.second - 2.0 * d.x * w.first - p.x * w.second) / w.value,
                  (y.second - 2.0 * d.y * w.first - p.y * w.second) / w.value};
    return {p, d, dd};
}

Run::Nearest Run::nearest(Vec2 p) const {
    const auto closest = std::min_element(samples_.begin(), samples_.end(), [&](Vec2 a, Vec2 b) {
        return dot(a - p, a - p) < dot(b - p, b - p);
    });
    const double at = static_cast<double>(closest - samples_.begin()) / kSamples;
    // Newton's method on the derivative of the squared distance, held between the neighbours of the closest sample.
    double lo = at - 1.0 / kSamples;
    double hi = at + 1.0 / kSamples;
    if (!is_closed_) {
        lo = std::max(lo, 0.0);
        hi = std::min(hi, end());
    }
    double u = at;
    Jet j = jet(u);
    for (int i = 0; i < 60; ++i) {
        const Vec2 d = j.value - p;
        const double slope = dot(d, j.first);
        (slope > 0.0 ? hi : lo) = u;
        const double bend = dot(j.first, j.first) + dot(d, j.second);
        double next = bend > 0.0 ? u - slope / bend : 0.5 * (lo + hi);
        if (!(next > lo && next < hi)) next = 0.5 * (lo + hi);
        if (std::fabs(next - u) <= 0x1p-52 * (1.0 + std::fabs(u))) break;
        u = next;
        j = jet(u);
    }
    const double speed = norm(j.first);
    if (!(speed > 0.0)) return {j.value, {1.0, 0.0}, norm(p - j.value), u};
    const Vec2 way = j.first * (1.0 / speed);
    const Vec2 normal{way.y, -way.x};
    // Beyond an end the run goes on along its tangent.
    if (!is_closed_ && (u <= 0x1p-40 || u >= end() * (1.0 - 0x1p-40))) {
        const double along = dot(p - j.value, way);
        return {j.value + way * along, normal, dot(p - j.value, normal),
                u < 0.5 * end() ? 0.0 : end()};
    }
    // Not the length of p - foot, which next to the curve would be that of the foot's own error along it.
    return {j.value, normal, dot(p - j.value, normal), u};
}

Run::Seen Run::seen(Vec3 p, double height) const {
    const Vec2 q{p.x, p.y};
    // The square of the distance from the ray, without the cancellation of a far eye.
    const auto off = [&](Vec2 at) {
        const double along =
            dot(q - at, at) + p.z * height;  // of p from `at`, times the ray's length
        const double square = dot(at, at) + height * height;
        if (along + square < 0.0) return dot(q, q) + (p.z + height) * (p.z + height);
        return dot(q - at, q - at) + p.z * p.z - along * along / square;
    };
    std::size_t closest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < samples_.size(); ++i) {
        const double here = off(samples_[i]);
        if (!(here < least)) continue;
        least = here;
        closest = i;
    }
    const double at = static_cast<double>(closest) / kSamples;
    double lo = at - 1.0 / kSamples;
    double hi = at + 1.0 / kSamples;
    if (!is_closed_) {
        lo = std::max(lo, 0.0);
        hi = std::min(hi, end());
    }
    // Newton's method on (d.D') (D.D) - (d.D) (D.D') by h^2, with d = (q, h + z) and D = (P, h), held between the neighbours of
    // the closest sample.
    const double flat = 1.0 / (height * height);
    const double tilt = p.z / height;
    double u = at;
    Jet j = jet(u);
    for (int i = 0; i < 60; ++i) {
        const double turn = dot(j.value, j.first);
        const double turn_first = dot(j.first, j.first) + dot(j.value, j.second);
        const double square = dot(j.value, j.value);
        const double along = dot(q, j.value);
        const double slope = dot(q - j.value, j.first) +
                             (square * dot(q, j.first) - along * turn) * flat - tilt * turn;
        (slope > 0.0 ? lo : hi) = u;
        const double bend =
            dot(q - j.value, j.second) - dot(j.first, j.first) +
            (turn * dot(q, j.first) + square * dot(q, j.second) - along * turn_first) * flat -
            tilt * turn_first;
        double next = bend < 0.0 ? u - slope / bend : 0.5 * (lo + hi);
        if (!(next > lo && next < hi)) next = 0.5 * (lo + hi);
        if (std::fabs(next - u) <= 0x1p-52 * (1.0 + std::fabs(u))) break;
        u = next;
        j = jet(u);
    }
    const double speed = norm(j.first);
    const Vec2 normal = speed > 0.0 ? Vec2{j.first.y, -j.first.x} * (1.0 / speed) : Vec2{1.0, 0.0};
    return {j.value, normal};
}

Run::Moved Run::moved(double u, double by) const {
    const Jet j = jet(u);
    const double speed = norm(j.first);
    if (!(speed > 0.0)) {
        const Nearest here = nearest(j.value);
        return {j.value + here.normal * by, {}};
    }
    const Vec2 way = j.first * (1.0 / speed);
    // What is moved outwards is as much longer as it turns.
    const double turn = cross(j.first, j.second) / (speed * speed);
    return {j.value + Vec2{way.y, -way.x} * by, j.first + way * (by * turn)};
}

std::vector<Vec2> Run::crossings(const std::function<double(Vec2)>& distance) const {
    const double last = end();
    const double more = kBeyondEnds * size_;
    const Nearest first_end = nearest(jet(0.0).value);
    const Nearest last_end = nearest(jet(last).value);
    const auto place = [&](double v) {
        // The normal is to the right of the way.
        if (!is_closed_ && v < 0.0)
            return first_end.point + Vec2{-first_end.normal.y, first_end.normal.x} * (more * v);
        if (!is_closed_ && v > last)
            return last_end.point +
                   Vec2{-last_end.normal.y, last_end.normal.x} * (more * (v - last));
        return jet(v).value;
    };
    struct Part {
        double from, to;
        Vec2 at_from, at_to;
        double before, after;
        int halvings;
    };
    std::vector<Vec2> out;
    std::vector<Part> open;
    const auto look = [&](double from, double to) {
        const Vec2 p = place(from);
        const Vec2 q = place(to);
        open.push_back({from, to, p, q, distance(p), distance(q), 0});
        while (!open.empty()) {
            const Part part = open.back();
            open.pop_back();
            const double middle = 0.5 * (part.from + part.to);
            const Vec2 at = place(middle);
            const bool is_change = (part.before < 0.0) != (part.after < 0.0);
            // Arcs are a little longer than their chords.
            const double way = 1.25 * (norm(at - part.at_from) + norm(part.at_to - at));
            if (!is_change && std::fabs(part.before) + std::fabs(part.after) > way) continue;
            if (part.halvings < kMostHalvings) {
                const double between = distance(at);
                open.push_back(
                    {middle, part.to, at, part.at_to, between, part.after, part.halvings + 1});
                open.push_back(
                    {part.from, middle, part.at_from, at, part.before, between, part.halvings + 1});
                continue;
            }
            if (!is_change) continue;
            double inner = part.from;
            double outer = part.to;
            for (int k = 0; k < 60; ++k) {
                const double v = 0.5 * (inner + outer);
                ((distance(place(v)) < 0.0) == (part.before < 0.0) ? inner : outer) = v;
            }
            out.push_back(place(0.5 * (inner + outer)));
        }
    };
    if (!is_closed_) look(-1.0, 0.0);
    for (std::size_t i = 0; i < spans_.size() * kSamples; ++i) {
        look(static_cast<double>(i) / kSamples, static_cast<double>(i + 1) / kSamples);
    }
    if (!is_closed_) look(last, last + 1.0);
    return out;
}

void Run::append_moved(double from, double to, double by, curves::Curve& curve) const {
    if (is_closed_) to += end() * std::round((from - to) / end());
    const double sense = to < from ? -1.0 : 1.0;
    double u = from;
    while (sense * (to - u) > 0.0) {
        // To the end of the span, or as far as is asked for.
        const double whole = sense > 0.0 ? std::floor(u) : std::ceil(u) - 1.0;
        const double limit = sense > 0.0 ? std::min(whole + 1.0, to) : std::max(whole, to);
        const auto count = static_cast<std::ptrdiff_t>(spans_.size());
        const auto index = (static_cast<std::ptrdiff_t>(whole) % count + count) % count;
        const auto& w = spans_[static_cast<std::size_t>(index)].w;
        const bool is_polynomial = w == std::array<double, 4>{1.0, 1.0, 1.0, 1.0};
        const int parts = is_polynomial ? kPolynomialParts : kRationalParts;
        Moved p = moved(u, by);
        const double step = (limit - u) / parts;
        for (int i = 1; i <= parts; ++i) {
            const double at = i == parts ? limit : u + step * i;
            const Moved q = moved(at, by);
            curve.spans.push_back(curves::cubic(p.point, p.point + p.way * (step / 3.0),
                                                q.point - q.way * (step / 3.0), q.point));
            p = q;
        }
        u = limit;
    }
}

Run Run::mapped(const Affine2& map) const {
    std::vector<curves::Span2> spans = spans_;
    for (curves::Span2& span : spans) span = curves::mapped(span, map);
    if (map.determinant() < 0.0) {
        std::reverse(spans.begin(), spans.end());
        for (curves::Span2& span : spans) span = curves::reversed(span);
    }
    return {std::move(spans), is_closed_};
}

curves::Outline Run::left_of(Vec2 p, double reach) const {
    const Nearest here = nearest(p);
    const Vec2 way{-here.normal.y, here.normal.x};
    // To where it has turned too far, or ends; all of it is then a graph above `way`.
    const auto way_at = [&](double u) {
        const Vec2 d = jet(u).first;
        return norm(d) > 0.0 ? d * (1.0 / norm(d)) : way;
    };
    const auto limit_of = [&](double sense) {
        double u = here.at;
        for (std::size_t i = 0; i < spans_.size() * kSamples; ++i) {
            double next = u + sense / kSamples;
            if (!is_closed_) next = std::clamp(next, 0.0, end());
            if (next == u || !(dot(way_at(next), way) > 0.5)) break;
            u = next;
            // Half of a closed run to either side.
            if (is_closed_ && std::fabs(u - here.at) > 0.5 * end() - 1.0 / kSamples) break;
        }
        return u;
    };
    const double from = limit_of(-1.0);
    const double to = limit_of(1.0);
    const double length = 2.0 * reach;
    const double top = 4.0 * (reach + size_) + norm(p - here.point);
    const Vec2 first = jet(from).value - way_at(from) * length;
    const Vec2 last = jet(to).value + way_at(to) * length;
    const auto raised = [&](Vec2 q) {
        return q - here.normal * (top + dot(q - here.point, here.normal));
    };
    curves::Curve curve;
    curve.spans.push_back(curves::segment(first, jet(from).value));
    if (from < here.at) append_moved(from, here.at, 0.0, curve);
    if (here.at < to) append_moved(here.at, to, 0.0, curve);
    Vec2 at = curve.spans.back().point(3);
    for (const Vec2 next : {last, raised(last), raised(first), first}) {
        curve.spans.push_back(curves::segment(at, next));
        at = next;
    }
    curve.closed = true;
    curves::Outline outline;
    outline.curves.push_back(std::move(curve));
    return outline;
}

}  // namespace raymo::blends
