// The helix. In the plane, a cubic with control points at distance k = 4/3 tan(a/4) of the radius along the tangents is the
// arc of angle a but for 4/27 sin^6(a/4) / cos^2(a/4) of the radius, outwards: 1.0e-9 for a = 10 degrees. The height is the
// cubic whose derivatives at the ends are those of the helix, 3 k pitch / 2 pi: both are tangent to it there. It then differs
// from the height of the helix at the same angle by at most 3e-9 of the pitch.
#include "raymo/curves/build_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "raymo/curves/build_errors.hpp"
#include "raymo/curves/roots.hpp"

namespace raymo::curves {
namespace {

PathSpan span_of(const SplineSpan<4>& s) {
    PathSpan out;
    for (std::size_t i = 0; i < 4; ++i) {
        out.x[i] = s[i][0];
        out.y[i] = s[i][1];
        out.z[i] = s[i][2];
        out.r[i] = s[i][3];
    }
    return out;
}

/// Where r is 0 or has an extremum in (0, 1), ascending; the flag says: 0.
std::vector<std::pair<double, bool>> cuts_of(const Bernstein<3>& r) {
    std::vector<std::pair<double, bool>> cuts;
    const double noise = 8.0 * 0x1p-53 * size_of(r);
    RootList<3> zeros;
    find_roots<3>(r, noise, zeros);
    for (const Root& root : zeros) cuts.emplace_back(root.u, true);
    RootList<2> extrema;
    find_roots<2>(derivative(r), noise, extrema);
    for (const Root& root : extrema) cuts.emplace_back(root.u, false);
    std::sort(cuts.begin(), cuts.end());
    // What lies nearer together than this can not differ from 0 by more than its square, 2^-54 of the size.
    constexpr double kApart = 0x1p-27;
    std::vector<std::pair<double, bool>> kept;
    for (const auto& [u, is_zero] : cuts) {
        if (u < kApart || u > 1.0 - kApart) continue;
        if (!kept.empty() && u - kept.back().first < kApart) {
            kept.back().second = kept.back().second || is_zero;
        } else {
            kept.emplace_back(u, is_zero);
        }
    }
    return kept;
}

/// Appends a span whose radius may fall below 0, cut into pieces on which it does not, or is 0. Between two cuts the radius
/// neither changes its sign nor turns, so its sign in the middle is that of the piece.
/// True: some radius was raised to 0.
bool append_clamped(const PathSpan& span, std::vector<PathSpan>& out) {
    if (*std::min_element(span.r.begin(), span.r.end()) >= 0.0) {
        out.push_back(span);
        return false;
    }
    const auto cuts = cuts_of(span.r);
    std::vector<PathSpan> pieces;
    std::vector<bool> begins_at_zero{span.r[0] <= 0.0};
    PathSpan rest = span;
    double from = 0.0;
    for (const auto& [u, is_zero] : cuts) {
        PathSpan left;
        PathSpan right;
        const double at = (u - from) / (1.0 - from);
        split(rest.x, at, left.x, right.x);
        split(rest.y, at, left.y, right.y);
        split(rest.z, at, left.z, right.z);
        split(rest.r, at, left.r, right.r);
        pieces.push_back(left);
        begins_at_zero.push_back(is_zero || right.r[0] <= 0.0);
        rest = right;
        from = u;
    }
    pieces.push_back(rest);
    begins_at_zero.push_back(span.r[3] <= 0.0);
    bool is_raised = false;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (value_at(pieces[i].r, 0.5) > 0.0) continue;
        is_raised = true;
        pieces[i].r = {};
        if (i > 0) begins_at_zero[i] = true;
        if (i + 1 < pieces.size()) begins_at_zero[i + 1] = true;
        // The span's own ends stay those of its neighbours, to the bit.
        if (i == 0) pieces[i].r[0] = std::max(span.r[0], 0.0);
        if (i + 1 == pieces.size()) pieces[i].r[3] = std::max(span.r[3], 0.0);
    }
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        auto& r = pieces[i].r;
        // A radius that leaves 0 grows: what rounding made of its first coefficients is not allowed to differ.
        if (begins_at_zero[i]) {
            r[0] = 0.0;
            r[1] = std::max(r[1], 0.0);
            if (r[1] == 0.0) r[2] = std::max(r[2], 0.0);
        }
        if (begins_at_zero[i + 1]) {
            r[3] = 0.0;
            r[2] = std::max(r[2], 0.0);
            if (r[2] == 0.0) r[1] = std::max(r[1], 0.0);
        }
        out.push_back(pieces[i]);
    }
    return is_raised;
}

}  // namespace

Result<BuiltPath> spline_path(std::span<const Point<4>> points, const SplineForm& form) {
    bool has_size = false;
    for (const Point<4>& p : points) {
        if (!(p[3] >= 0.0))
            return wrong(0, "every radius must be at least 0", {}, "this has " + shown(p[3]));
        has_size = has_size || p[3] > 0.0;
    }
    auto made = spline<4>(points, form);
    if (!made) {
        Error error = std::move(made).error();
        if (error.message == "all points are the same")
            error.hint = "a ball that stays where it is is sphere(r)";
        return Failure(std::move(error));
    }
    if (!has_size) return wrong(0, "one radius at least must be greater than 0");
    return path_of(made->spans);
}

BuiltPath path_of(std::span<const SplineSpan<4>> spans) {
    BuiltPath out;
    out.path.spans.reserve(spans.size());
    for (const SplineSpan<4>& s : spans)
        out.is_clamped = append_clamped(span_of(s), out.path.spans) || out.is_clamped;
    const PathSpan& first = out.path.spans.front();
    const PathSpan& last = out.path.spans.back();
    out.path.closed = first.x[0] == last.x[3] && first.y[0] == last.y[3] &&
                      first.z[0] == last.z[3] && first.r[0] == last.r[3];
    return out;
}

Result<Path> helix(double radius, double pitch, double turns, double thickness) {
    const auto check = [](double value, int argument, const char* name) -> Result<void> {
        if (!(value > 0.0))
            return wrong(argument, std::string(name) + " must be greater than 0", {},
                         "this is " + shown(value));
        if (!(value <= kLargestCoordinate))
            return wrong(argument, std::string(name) + " is too large to be computed with",
                         "give at most 1e90", "this is " + shown(value));
        return {};
    };
    if (auto good = check(radius, 0, "the radius"); !good) return Failure(good.error());
    if (pitch == 0.0)
        return wrong(1, "the pitch must not be 0", "torus(R, r) is a ring that does not climb",
                     "this is 0");
    if (!(std::fabs(pitch) <= kLargestCoordinate))
        return wrong(1, "the pitch is too large to be computed with", "give at most 1e90",
                     "this is " + shown(pitch));
    if (auto good = check(turns, 2, "the number of turns"); !good) return Failure(good.error());
    if (auto good = check(thickness, 3, "the thickness"); !good) return Failure(good.error());
    constexpr double kSpansPerTurn = 36.0;
    const double count = std::ceil(kSpansPerTurn * turns);
    if (!(count <= kMostPathSpans))
        return wrong(2, "a helix of so many turns needs more than 1000000 spans",
                     "give at most 27000 turns", "this is " + shown(turns));
    if (!(std::fabs(pitch) * turns <= kLargestCoordinate))
        return wrong(1, "the helix is too high to be computed with", "stay within 1e90");
    const double angle = 2.0 * std::numbers::pi * turns / count;
    const double k = 4.0 / 3.0 * std::tan(0.25 * angle);
    const double climb = pitch * k / (2.0 * std::numbers::pi);
    const double r = 0.5 * thickness;
    Path out;
    out.spans.reserve(static_cast<std::size_t>(count));
    SinCos a = sin_cos_degrees(0.0);
    double low = 0.0;
    for (double i = 1; i <= count; ++i) {
        const SinCos b = sin_cos_degrees(i == count ? 360.0 * turns : 360.0 * turns * i / count);
        const double high = i == count ? pitch * turns : pitch * turns * i / count;
        PathSpan s;
        s.x = {radius * a.cos, radius * (a.cos - k * a.sin), radius * (b.cos + k * b.sin),
               radius * b.cos};
        s.y = {radius * a.sin, radius * (a.sin + k * a.cos), radius * (b.sin - k * b.cos),
               radius * b.sin};
        s.z = {low, low + climb, high - climb, high};
        s.r = {r, r, r, r};
        out.spans.push_back(s);
        a = b;
        low = high;
    }
    return out;
}

Path mapped(const Path& path, const Affine& map, double factor) {
    Path out = path;
    for (PathSpan& s : out.spans) {
        for (std::size_t i = 0; i < 4; ++i) {
            const Vec3 p = map(Vec3{s.x[i], s.y[i], s.z[i]});
            s.x[i] = p.x;
            s.y[i] = p.y;
            s.z[i] = p.z;
            s.r[i] *= factor;
        }
    }
    return out;
}

double extent_of(const Path& path) {
    double size = 0.0;
    for (const PathSpan& s : path.spans) {
        for (const Bernstein<3>* c : {&s.x, &s.y, &s.z, &s.r}) {
            for (const double x : *c) {
                const double at = std::fabs(x);
                size = at <= size ? size : (at > size ? at : Aabb::kInf);
            }
        }
    }
    return size;
}

double bytes_of(const Path& path) {
    return sizeof(Path) + 32.0 + static_cast<double>(path.spans.capacity() * sizeof(PathSpan));
}

}  // namespace raymo::curves
