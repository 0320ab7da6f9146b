#include "raymo/curves/build_spline.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "raymo/core/assert.hpp"
#include "raymo/core/shown.hpp"

namespace raymo::curves {

namespace {

template <std::size_t D, class F>
Point<D> by_coordinate(F&& f) {
    Point<D> out{};
    for (std::size_t k = 0; k < D; ++k) out[k] = f(k);
    return out;
}

/// (1 - u) a + u b.
template <std::size_t D>
Point<D> between(const Point<D>& a, const Point<D>& b, double u) {
    return by_coordinate<D>([&](std::size_t k) { return (1.0 - u) * a[k] + u * b[k]; });
}

/// (a + weight b) / (1 + weight).
template <std::size_t D>
Point<D> mean(const Point<D>& a, const Point<D>& b, double weight) {
    const double sum = 1.0 + weight;
    return by_coordinate<D>([&](std::size_t k) { return (a[k] + weight * b[k]) / sum; });
}

template <std::size_t D>
SplineSpan<D> line(const Point<D>& a, const Point<D>& b) {
    return {a, mean(b, a, 2.0), mean(a, b, 2.0), b};
}

/// The parabola with control points a, b, c.
template <std::size_t D>
SplineSpan<D> parabola(const Point<D>& a, const Point<D>& b, const Point<D>& c) {
    return {a, mean(a, b, 2.0), mean(c, b, 2.0), c};
}

/// The cubic from a to b with the derivatives da and db there.
template <std::size_t D>
SplineSpan<D> hermite(const Point<D>& a, const Point<D>& b, const Point<D>& da,
                      const Point<D>& db) {
    return {a, by_coordinate<D>([&](std::size_t k) { return a[k] + da[k] / 3.0; }),
            by_coordinate<D>([&](std::size_t k) { return b[k] - db[k] / 3.0; }), b};
}

// ---- Uniform B-splines

/// One span of the uniform B-spline with control points p[0..degree].
template <std::size_t D>
SplineSpan<D> uniform_span(const std::array<Point<D>, 4>& p, int degree) {
    if (degree == 1) return line(p[0], p[1]);
    if (degree == 2) return parabola(mean(p[0], p[1], 1.0), p[1], mean(p[1], p[2], 1.0));
    const auto joint = [](const Point<D>& a, const Point<D>& b, const Point<D>& c) {
        return by_coordinate<D>([&](std::size_t k) { return ((a[k] + c[k]) + 4.0 * b[k]) / 6.0; });
    };
    return {joint(p[0], p[1], p[2]), mean(p[2], p[1], 2.0), mean(p[1], p[2], 2.0),
            joint(p[1], p[2], p[3])};
}

/// Span `i` of `count` of the B-spline whose knots are 0, 1, ..., count, the first and the last repeated `degree` times more.
/// The blossom of its polynomial at (a.., b..), a = i and b = i + 1, gives its Bernstein coefficients [Farin02 8].
template <std::size_t D>
SplineSpan<D> clamped_span(const std::array<Point<D>, 4>& p, int degree, std::size_t i,
                           std::size_t count) {
    const auto knot = [&](int j) {  // of the knots about the span: knot(0) = i, knot(1) = i + 1
        return std::clamp(static_cast<double>(i) + j, 0.0, static_cast<double>(count));
    };
    std::array<Point<D>, 4> control{};
    for (int ones = 0; ones <= degree; ++ones) {
        std::array<Point<D>, 4> d = p;
        for (int r = 1; r <= degree; ++r) {
            const double at = knot(r <= ones ? 1 : 0);
            for (int j = degree; j >= r; --j) {
                const double low = knot(j - degree);
                const double high = knot(j - r + 1);
                const auto index = static_cast<std::size_t>(j);
                d[index] = between(d[index - 1], d[index], (at - low) / (high - low));
            }
        }
        control[static_cast<std::size_t>(ones)] = d[static_cast<std::size_t>(degree)];
    }
    if (degree == 1) return line(control[0], control[1]);
    if (degree == 2) return parabola(control[0], control[1], control[2]);
    return control;
}

template <std::size_t D>
void build_bspline(std::span<const Point<D>> points, const SplineForm& form, Spline<D>& out) {
    const std::size_t n = points.size();
    const auto degree = static_cast<std::size_t>(form.degree);
    const std::size_t count = form.closed ? n : n - degree;
    out.spans.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        std::array<Point<D>, 4> p{};
        for (std::size_t j = 0; j <= degree; ++j) p[j] = points[(i + j) % n];
        // Away from the ends the knots about a span are evenly spaced.
        const bool is_inner = i + 1 >= degree && i + degree <= count;
        out.spans.push_back(form.clamped && !is_inner ? clamped_span<D>(p, form.degree, i, count)
                                                      : uniform_span<D>(p, form.degree));
    }
    // The blossoms of two neighbours give the same point with roundings of their own.
    for (std::size_t i = 1; i < count; ++i) out.spans[i][0] = out.spans[i - 1][3];
    if (form.clamped) {
        out.spans.front()[0] = points.front();
        out.spans.back()[3] = points.back();
    }
}

// ---- Through the points

/// Cubics through the points with a derivative at each.
template <std::size_t D, class Derivative>
void build_through(std::span<const Point<D>> points, bool closed, Derivative&& derivative,
                   Spline<D>& out) {
    const std::size_t n = points.size();
    const std::size_t count = closed ? n : n - 1;
    out.spans.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t next = (i + 1) % n;
        out.spans.push_back(hermite<D>(points[i], points[next], derivative(i), derivative(next)));
    }
}

template <std::size_t D>
void build_catmull(std::span<const Point<D>> p, bool closed, Spline<D>& out) {
    const std::size_t n = p.size();
    build_through<D>(
        p, closed,
        [&](std::size_t i) {
            // An open curve goes on beyond its ends as far as it came: 2 p0 - p1 lies before p0.
            if (!closed && (i == 0 || i + 1 == n)) {
                const std::size_t a = i == 0 ? 0 : n - 2;
                return by_coordinate<D>([&](std::size_t k) { return p[a + 1][k] - p[a][k]; });
            }
            const Point<D>& before = p[(i + n - 1) % n];
            const Point<D>& after = p[(i + 1) % n];
            return by_coordinate<D>([&](std::size_t k) { return 0.5 * (after[k] - before[k]); });
        },
        out);
}

/// The derivatives d of the cubic spline: d[i - 1] + 4 d[i] + d[i + 1] = 3 (p[i + 1] - p[i - 1]), and at an open end, where
/// the second derivative is 0, 2 d[0] + d[1] = 3 (p[1] - p[0]). The matrix is diagonally dominant, so elimination needs no
/// pivots and loses no digits. The corners of the cyclic system are taken out by the formula of Sherman and Morrison.
template <std::size_t D>
std::vector<Point<D>> spline_derivatives(std::span<const Point<D>> p, bool closed) {
    const std::size_t n = p.size();
    std::vector<Point<D>> d(n);
    std::vector<double> upper(n);  // superdiagonal after elimination
    std::vector<double> corner;    // solution for the cyclic system's extra column
    if (closed) corner.assign(n, 0.0);
    // With u = (1, 0, ..., 0, 1): A = B + u u^T, where B lacks the corners and has 3 for the first and last diagonal.
    for (std::size_t i = 0; i < n; ++i) {
        const bool is_first = i == 0;
        const bool is_last = i + 1 == n;
        const double diagonal = is_first || is_last ? (closed ? 3.0 : 2.0) : 4.0;
        const std::size_t before = is_first ? (closed ? n - 1 : 0) : i - 1;
        const std::size_t after = is_last ? (closed ? 0 : n - 1) : i + 1;
        const double pivot = diagonal - (is_first ? 0.0 : upper[i - 1]);
        upper[i] = 1.0 / pivot;
        d[i] = by_coordinate<D>([&](std::size_t k) {
            const double right = 3.0 * (p[after][k] - p[before][k]);
            return (right - (is_first ? 0.0 : d[i - 1][k])) / pivot;
        });
        if (closed) {
            const double right = is_first || is_last ? 1.0 : 0.0;
            corner[i] = (right - (is_first ? 0.0 : corner[i - 1])) / pivot;
        }
    }
    for (std::size_t i = n - 1; i-- > 0;) {
        for (std::size_t k = 0; k < D; ++k) d[i][k] -= upper[i] * d[i + 1][k];
        if (closed) corner[i] -= upper[i] * corner[i + 1];
    }
    if (closed) {
        const double scale = 1.0 / (1.0 + (corner[0] + corner[n - 1]));
        const auto ends =
            by_coordinate<D>([&](std::size_t k) { return scale * (d[0][k] + d[n - 1][k]); });
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t k = 0; k < D; ++k) d[i][k] -= ends[k] * corner[i];
        }
    }
    return d;
}

template <std::size_t D>
void build_bezier(std::span<const Point<D>> p, const SplineForm& form, Spline<D>& out) {
    const std::size_t n = p.size();
    const auto degree = static_cast<std::size_t>(form.degree);
    const std::size_t count = form.closed ? n / degree : (n - 1) / degree;
    out.spans.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto at = [&](std::size_t j) { return p[(i * degree + j) % n]; };
        out.spans.push_back(degree == 1   ? line<D>(at(0), at(1))
                            : degree == 2 ? parabola<D>(at(0), at(1), at(2))
                                          : SplineSpan<D>{at(0), at(1), at(2), at(3)});
    }
}

// ---- Checks

Failure wrong_points(std::string message, std::string hint, std::string label) {
    return Failure(Error{
        ErrorCode::out_of_range, std::move(message), std::move(label), std::move(hint), 0, {}});
}

template <std::size_t D>
Result<void> check_points(std::span<const Point<D>> points) {
    bool differ = false;
    for (const Point<D>& p : points) {
        for (std::size_t k = 0; k < D; ++k) {
            if (!std::isfinite(p[k]))
                return wrong_points("every coordinate must be a finite number", {},
                                    "this has " + shown(p[k]));
            if (std::fabs(p[k]) > kLargestCoordinate)
                return wrong_points("the coordinates are too large to be computed with",
                                    "stay within 1e90 of the origin", "this has " + shown(p[k]));
            if (k < 3) differ = differ || p[k] != points[0][k];
        }
    }
    if (!differ && points.size() > 1)
        return wrong_points("all points are the same", "a curve needs places that differ", {});
    return {};
}

std::string these(std::size_t n) {
    return n == 1 ? "this is 1 point" : "these are " + std::to_string(n) + " points";
}

Result<void> check_count(std::size_t n, const SplineForm& form) {
    const auto degree = static_cast<std::size_t>(form.degree);
    if (form.kind == SplineKind::bezier) {
        // One closed parabola would run back over itself.
        const std::size_t first = form.closed ? (degree == 3 ? 3 : 4) : degree + 1;
        if (n >= first && (n - first) % degree == 0) return {};
        return wrong_points(
            std::string(form.closed ? "a closed" : "a") + " chain of Bezier curves of degree " +
                std::to_string(degree) + " needs " + std::to_string(first) + ", " +
                std::to_string(first + degree) + ", " + std::to_string(first + 2 * degree) +
                " or more points",
            form.closed ? "the last span ends at the first point"
                        : "each span begins at the point where the one before it ends",
            these(n));
    }
    if (form.closed) {
        if (n >= 3) return {};
        return wrong_points("a closed curve needs at least 3 points", {}, these(n));
    }
    const std::size_t least = form.kind == SplineKind::bspline ? degree + 1 : 2;
    if (n >= least) return {};
    if (least == 2) return wrong_points("a curve needs at least 2 points", {}, these(n));
    return wrong_points("a curve of degree " + std::to_string(degree) + " needs at least " +
                            std::to_string(least) + " points",
                        "give more points or a lower degree", these(n));
}

}  // namespace

template <std::size_t D>
Result<Spline<D>> spline(std::span<const Point<D>> points, const SplineForm& form) {
    if (form.degree < 1 || form.degree > 3) {
        return Failure(Error{ErrorCode::out_of_range,
                             "the degree must be 1, 2 or 3",
                             "this is " + std::to_string(form.degree),
                             {},
                             1,
                             {}});
    }
    if (auto checked = check_points(points); !checked) return Failure(checked.error());
    SplineForm f = form;
    const bool has_degree = f.kind == SplineKind::bspline || f.kind == SplineKind::bezier;
    if (has_degree && f.degree == 1) f.kind = SplineKind::linear;
    const bool is_through = f.kind == SplineKind::linear || f.kind == SplineKind::catmull ||
                            f.kind == SplineKind::interpolate;
    const bool comes_back = points.size() > 1 && points.front() == points.back();
    if (f.closed && comes_back) {
        if (is_through) {
            points = points.first(points.size() - 1);
        } else if (f.kind == SplineKind::bezier) {
            f.closed = false;  // as open as it is closed
        }
    }
    if (auto checked = check_count(points.size(), f); !checked) return Failure(checked.error());
    RAYMO_ASSERT(!(f.closed && f.clamped));
    Spline<D> out;
    switch (f.kind) {
        case SplineKind::linear:
            f.degree = 1;
            f.clamped = false;
            build_bspline<D>(points, f, out);
            break;
        case SplineKind::bspline:
            build_bspline<D>(points, f, out);
            break;
        case SplineKind::bezier:
            build_bezier<D>(points, f, out);
            break;
        case SplineKind::catmull:
            build_catmull<D>(points, f.closed, out);
            break;
        case SplineKind::interpolate: {
            const auto d = spline_derivatives<D>(points, f.closed);
            build_through<D>(
                points, f.closed, [&](std::size_t i) { return d[i]; }, out);
            break;
        }
    }
    // Spans of no length say nothing.
    std::erase_if(out.spans, [&](const SplineSpan<D>& s) {
        return s[0] == s[3] && (f.kind == SplineKind::linear || (s[0] == s[1] && s[1] == s[2]));
    });
    // Points may differ by less than the sums of a span show.
    if (out.spans.empty())
        return wrong_points("all points are the same", "a curve needs places that differ", {});
    out.closed = out.spans.back()[3] == out.spans.front()[0];
    return out;
}

template Result<Spline<2>> spline<2>(std::span<const Point<2>>, const SplineForm&);
template Result<Spline<4>> spline<4>(std::span<const Point<4>>, const SplineForm&);

}  // namespace raymo::curves
