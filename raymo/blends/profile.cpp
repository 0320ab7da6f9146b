#include "raymo/blends/profile.hpp"

#include <algorithm>
#include <cmath>

#include "raymo/curves/bernstein.hpp"

namespace raymo::blends {
namespace {

constexpr int kSamples = 8;  // for each span

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
    if (!(speed > 0.0)) return {j.value, {1.0, 0.0}, norm(p - j.value)};
    const Vec2 way = j.first * (1.0 / speed);
    const Vec2 normal{way.y, -way.x};
    // Beyond an end the run goes on along its tangent.
    if (!is_closed_ && (u <= 0x1p-40 || u >= end() * (1.0 - 0x1p-40))) {
        const double along = dot(p - j.value, way);
        return {j.value + way * along, normal, dot(p - j.value, normal)};
    }
    // Not the length of p - foot, which next to the curve would be that of the foot's own error along it.
    return {j.value, normal, dot(p - j.value, normal)};
}

}  // namespace raymo::blends
