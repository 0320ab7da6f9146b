// A line against patches.
//
// Seen along the line, a patch is a map f(u, v) of a square to the plane, and the line meets it where f = 0. e bounds how far
// the line and what is computed of f may be off together. a x b is the cross product of the plane, J = f_u x f_v.
//
// Once. Let A and B be convex cones of vectors that hold all f_u, and all f_v, over a part of the patch, with a x b > 0 for
// all a of A and b of B (or < 0 for all). From p to q, first in u and then in v,
//     f(q) - f(p) = (q_u - p_u) a + (q_v - p_v) b,  a in A, b in B,                                              (1)
// since means of derivatives are in their cones. That is not 0 unless p = q: the part is met once at most. (Where the border
// has shrunk to a point, f_u = 0; cones do not mind, if f_v is not 0 there.) For a leaf, A and B are balls about the mean
// derivatives (surface.hpp), which can be looked at for any direction at little cost; where these are too wide, control
// vectors are turned into cones by their outermost directions, and the part is halved until that will do.
//
// Where. Newton's steps, kept within the part, find the place. If they want to leave it at a border, say u = u1 at q, then by
// (1) a zero p in the part would have
//     0 >= p_u - q_u = -(f(q) x b) / (a x b),
// so there is none if f(q) x b and a x b differ in sign for all b of B; with a margin of e |b|, there is none for any line
// within e.
//
// How well. Let g = max(|f_u|, |f_v|) / |J| and let all second derivatives nearby be less than b. A line that is off by e
// meets the patch at a distance x = max(|du|, |dv|) with  x <= g (e + 2 b x^2), which has a solution x <= 2 g e, and none
// between that and 1 / 4 b g, if
//     8 b g^2 e <= 1.                                                                                            (2)
// More closely, |du| <= 2 e |f_v| / |J| and |dv| <= 2 e |f_u| / |J|: a line along a border knows well on which side it is.
// There the surface is off its tangent plane by no more than 2 b x^2 <= e, so the line is crossed within
//     2 e / sin(angle between line and surface)
// of s. A place that is further than that from the patch's border is a crossing of all those lines; one that is closer is
// a doubt. Where (2) does not hold, the line is tangent to the surface, as far as one can know: the part is halved until, seen
// along the line, it is no wider than e, and told as a doubt. (It may be longer, where f_u and f_v are parallel: then all of
// it is next to the line, as far as one can know. Where they are not, it is halved along its longer side first.) Bounds of second derivatives on [0, 1]^2 hold beyond it by 1/8 in
// both directions when taken (5/4)^4 times as large.
#include "raymo/solids/freeform/search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace raymo::solids {
namespace {

/// Parts of one leaf that are looked at, at most; tangents need one or two hundred.
constexpr int kMostParts = 1000;
/// Halvings that wait: of u and of v, until parts are smaller than any error.
constexpr std::size_t kMostHalvings = 128;
/// Sides of a part that differ by no more than this, as seen across the line, are about equal.
constexpr double kEven = 4.0;

/// What control vectors across a line may be off by: three times the difference of two points.
constexpr double kVectorError = 6.0 * 0x1p-50;

double length(Vec2 a) { return std::sqrt(dot(a, a)); }

/// A part of a patch, seen along a line: b_ij at 4 i + j; s along the line.
struct Seen {
    std::array<double, 16> x, y, s;
    PatchPart part;

    [[nodiscard]] Vec2 point(std::size_t k) const { return {x[k], y[k]}; }
};

double longest(const std::array<Vec2, 12>& w, Vec2& which) {
    double most = -1.0;
    for (const Vec2 a : w) {
        const double size = dot(a, a);
        if (!(size > most)) continue;
        most = size;
        which = a;
    }
    return std::sqrt(most);
}

/// Of the points, across the direction `d`.
double width(const Seen& c, Vec2 d) {
    const double size = length(d);
    if (!(size > 0.0)) return 0.0;
    double lo = std::numeric_limits<double>::infinity(), hi = -lo;
    for (std::size_t k = 0; k < 16; ++k) {
        const double h = d.x * c.y[k] - d.y * c.x[k];
        lo = std::min(lo, h);
        hi = std::max(hi, h);
    }
    return (hi - lo) / size;
}

/// False: they do not lie within half a turn.
bool cone_of(const std::array<Vec2, 12>& w, FreeformCone& out) {
    Vec2 sum;
    for (const Vec2 a : w) sum += a;
    bool any = false;
    for (const Vec2 a : w) {
        if (a.x == 0.0 && a.y == 0.0) continue;
        if (!(dot(sum, a) > 0.0)) return false;
        if (!any || cross(out.lo, a) < 0.0) out.lo = a;
        if (!any || cross(out.hi, a) > 0.0) out.hi = a;
        any = true;
    }
    out.radius = 0.0;
    return any;
}

bool turn_one_way(const FreeformCone& a, const FreeformCone& b) {
    const auto sign = [](Vec2 p, Vec2 q) {
        const double turn = cross(p, q);
        const double doubt = kVectorError * (std::fabs(p.x) + std::fabs(p.y) + std::fabs(q.x) +
                                             std::fabs(q.y) + kVectorError);
        return turn > doubt ? 1 : (turn < -doubt ? -1 : 0);
    };
    const int first = sign(a.lo, b.lo);
    return first != 0 && sign(a.lo, b.hi) == first && sign(a.hi, b.lo) == first &&
           sign(a.hi, b.hi) == first;
}

/// Whether all points are on one side of the line through the origin along `d`, by more than e.
bool beside(const Seen& c, Vec2 d, double e) {
    const double margin = e * length(d);
    double lo = std::numeric_limits<double>::infinity(), hi = -lo;
    for (std::size_t k = 0; k < 16; ++k) {
        const double h = d.x * c.y[k] - d.y * c.x[k];
        lo = std::min(lo, h);
        hi = std::max(hi, h);
    }
    return lo > margin || hi < -margin;
}

bool missed(const Seen& c, double e) {
    const auto [x0, x1] = std::minmax_element(c.x.begin(), c.x.end());
    if (*x0 > e || *x1 < -e) return true;
    const auto [y0, y1] = std::minmax_element(c.y.begin(), c.y.end());
    if (*y0 > e || *y1 < -e) return true;
    return beside(c, c.point(12) - c.point(0), e) || beside(c, c.point(3) - c.point(0), e);
}

void halve(double& c0, double& c1, double& c2, double& c3, double& d0, double& d1, double& d2,
           double& d3) {
    const double a = 0.5 * (c0 + c1), m = 0.5 * (c1 + c2), b = 0.5 * (c2 + c3);
    const double am = 0.5 * (a + m), mb = 0.5 * (m + b);
    d3 = c3, d2 = b, d1 = mb;
    c3 = d0 = 0.5 * (am + mb);
    c1 = a, c2 = am;
}

void halve(Seen& c, bool in_u, Seen& other) {
    const std::size_t step = in_u ? 4 : 1;
    const std::size_t across = in_u ? 1 : 4;
    for (std::array<double, 16> Seen::*f : {&Seen::x, &Seen::y, &Seen::s}) {
        for (std::size_t n = 0; n < 4; ++n) {
            const std::size_t k = n * across;
            auto& p = c.*f;
            auto& q = other.*f;
            halve(p[k], p[k + step], p[k + 2 * step], p[k + 3 * step], q[k], q[k + step],
                  q[k + 2 * step], q[k + 3 * step]);
        }
    }
    other.part = c.part;
    if (in_u) {
        c.part.u1 = other.part.u0 = 0.5 * (c.part.u0 + c.part.u1);
    } else {
        c.part.v1 = other.part.v0 = 0.5 * (c.part.v0 + c.part.v1);
    }
}

/// Next to where a border has shrunk to a point.
bool is_uneven(Vec2 fu, Vec2 fv) {
    const double a = dot(fu, fu), b = dot(fv, fv);
    return a < 1e-4 * b || b < 1e-4 * a;
}

/// How far a patch bends from its tangent plane next to a place.
class Bend {
public:
    /// `bend`: no second derivative nearby is larger.
    Bend(const Patch& patch, double u, double v, double bend) : bend_(bend) {
        const auto derivatives = [](double x, std::array<std::array<double, 4>, 4>& out) {
            const CubicWeights w(x);
            out = {w.value, w.slope,
                   std::array<double, 4>{6.0 * (1.0 - x), 18.0 * x - 12.0, 6.0 - 18.0 * x, 6.0 * x},
                   std::array<double, 4>{-6.0, 18.0, -18.0, 6.0}};
        };
        std::array<std::array<double, 4>, 4> f, g;
        derivatives(u, f);
        derivatives(v, g);
        const auto size = [&](std::size_t in_u, std::size_t in_v) {
            Vec3 sum;
            for (std::size_t i = 0; i < 4; ++i) {
                for (std::size_t j = 0; j < 4; ++j)
                    sum += patch.point(i, j) * (f[in_u][i] * g[in_v][j]);
            }
            return norm(sum);
        };
        uu_ = size(2, 0), uv_ = size(1, 1), vv_ = size(0, 2);
        uuu_ = size(3, 0), vvv_ = size(0, 3);
    }
    /// At most, within x of u and y of v. Third derivatives are at most 6 times the bound of second ones, and fourth ones
    /// 54 times.
    [[nodiscard]] double off(double x, double y) const {
        const double third = 6.0 * bend_, fourth = 54.0 * bend_;
        const double uu = uu_ + (uuu_ + fourth * y) * x + third * y;
        const double uv = uv_ + third * (x + y);
        const double vv = vv_ + (vvv_ + fourth * x) * y + third * x;
        return 0.5 * (uu * x * x + 2.0 * uv * x * y + vv * y * y);
    }

private:
    double bend_, uu_, uv_, vv_, uuu_, vvv_;
};

/// Whether f x b has the sign of `way` for all b of the cone, and for all f within e.
bool turns(Vec2 f, const FreeformCone& cone, double way, double e) {
    const double size = length(f);
    const auto far = [&](Vec2 b) {
        return way * cross(f, b) > cone.radius * size + e * (length(b) + cone.radius);
    };
    return far(cone.lo) && far(cone.hi);
}

}  // namespace

void FreeformFound::add(const FreeformHit& hit) {
    for (const FreeformHit& known : hits) {
        if (known.patch == hit.patch && std::fabs(known.u - hit.u) <= known.blur_u + hit.blur_u &&
            std::fabs(known.v - hit.v) <= known.blur_v + hit.blur_v)
            return;
    }
    hits.push_back(hit);
}

void FreeformFound::doubt(const FreeformDoubt& doubt) {
    for (FreeformDoubt& known : doubts) {
        if (doubt.lo > known.hi || doubt.hi < known.lo || doubt.is_border || known.is_border)
            continue;
        known.lo = std::min(known.lo, doubt.lo);
        known.hi = std::max(known.hi, doubt.hi);
        return;
    }
    doubts.push_back(doubt);
}

FreeformSearch::Answer FreeformSearch::solve(std::uint32_t number, const PatchPart& part,
                                             const FreeformCone& du, const FreeformCone& dv,
                                             double u, double v) {
    const Patch& patch = surface_.patches[number];
    const double bend = kBeyondPatch * patch.bend;
    const double e = line_.error;
    const double way = cross(du.lo, dv.lo) > 0.0 ? 1.0 : -1.0;
    for (int step = 0; step < kMostFreeformSteps; ++step) {
        const PatchJet jet = patch.at(u, v);
        const Vec3 from = jet.at - line_.o;
        const Vec2 f = across(from);
        const Vec2 fu = across(jet.du);
        const Vec2 fv = across(jet.dv);
        const double turn = cross(fu, fv);
        // Where a border has shrunk to a point, rounding is all there is of f_u.
        if (!(turn * way > 0.0)) return Answer::unclear;
        const double inverse = 1.0 / turn;
        const double step_u = -cross(f, fv) * inverse;
        const double step_v = -cross(fu, f) * inverse;
        const double per_e = 2.0 * std::fabs(inverse);
        const double blur_u = e * per_e * length(fv);
        const double blur_v = e * per_e * length(fu);
        const double next_u = u + step_u;
        const double next_v = v + step_v;
        const double size = std::max(std::fabs(step_u), std::fabs(step_v));
        const bool within = next_u >= part.u0 - blur_u && next_u <= part.u1 + blur_u &&
                            next_v >= part.v0 - blur_v && next_v <= part.v1 + blur_v;
        // What the next step would be, across the line, is far below its error.
        bool arrived = 16.0 * bend * (size * size) <= kFreeformOwnError;
        const double blur = std::max(blur_u, blur_v);
        bool is_sure = 2.0 * bend * (blur * blur) <= e && blur <= 0.125;
        if (within && !(arrived && is_sure) && blur <= 0.125 && is_uneven(fu, fv)) {
            const Bend local(patch, u, v, bend);
            arrived = 8.0 * local.off(std::fabs(step_u), std::fabs(step_v)) <= kFreeformOwnError;
            is_sure = local.off(blur_u, blur_v) <= e;
        }
        if (within && arrived) {
            if (!is_sure) return Answer::unclear;
            const Vec3 n = cross(jet.du, jet.dv);
            const double slope = std::fabs(turn) / std::sqrt(dot(n, n));
            FreeformHit hit;
            hit.s = dot(from, line_.along) + dot(jet.du, line_.along) * step_u +
                    dot(jet.dv, line_.along) * step_v;
            hit.reach = 2.0 * e / slope;
            if (std::min(next_u, 1.0 - next_u) <= blur_u ||
                std::min(next_v, 1.0 - next_v) <= blur_v) {
                found_.doubt({hit.s - hit.reach, hit.s + hit.reach, true});
                return Answer::done;
            }
            hit.u = next_u;
            hit.v = next_v;
            hit.blur_u = blur_u;
            hit.blur_v = blur_v;
            hit.patch = number;
            hit.turn = turn < 0.0 ? 1 : -1;
            found_.add(hit);
            return Answer::done;
        }
        if (u == part.u1 && step_u > 0.0 && turns(f, dv, -way, e)) return Answer::done;
        if (u == part.u0 && step_u < 0.0 && turns(f, dv, way, e)) return Answer::done;
        if (v == part.v1 && step_v > 0.0 && turns(f, du, way, e)) return Answer::done;
        if (v == part.v0 && step_v < 0.0 && turns(f, du, -way, e)) return Answer::done;
        const double clamped_u = std::clamp(next_u, part.u0, part.u1);
        const double clamped_v = std::clamp(next_v, part.v0, part.v1);
        if (clamped_u == u && clamped_v == v) return Answer::unclear;
        u = clamped_u;
        v = clamped_v;
    }
    return Answer::unclear;
}

void FreeformSearch::meet(const FreeformLeaf& leaf) {
    const Vec2 p = across(leaf.middle - line_.o);
    const Vec2 a = across(leaf.du);
    const Vec2 b = across(leaf.dv);
    const double turn = cross(a, b);
    const double la = length(a);
    const double lb = length(b);
    const double su = leaf.spread_u;
    const double sv = leaf.spread_v;
    // f = p + x a + y b + r
    const double rest = 0.5 * (su + sv) + line_.error;
    const double pb = cross(p, b);
    const double pa = cross(p, a);
    const double half = 0.5 * std::fabs(turn);
    if (std::fabs(pb) > half + rest * lb || std::fabs(pa) > half + rest * la) return;
    if (2.0 * half <= su * lb + sv * la + su * sv) {
        search(leaf.patch, leaf.part);
        return;
    }
    const double x = -pb / turn;
    const double y = pa / turn;
    const PatchPart& part = leaf.part;
    const double u = 0.5 * (part.u0 + part.u1) + std::clamp(x, -0.5, 0.5) * (part.u1 - part.u0);
    const double v = 0.5 * (part.v0 + part.v1) + std::clamp(y, -0.5, 0.5) * (part.v1 - part.v0);
    if (solve(leaf.patch, part, {a, a, su}, {b, b, sv}, std::clamp(u, part.u0, part.u1),
              std::clamp(v, part.v0, part.v1)) == Answer::unclear)
        search(leaf.patch, part);
}

void FreeformSearch::search(std::uint32_t number, const PatchPart& whole) {
    const Patch patch = restricted(surface_.patches[number], whole);
    std::array<Seen, kMostHalvings> open;
    std::size_t count = 1;
    open[0].part = whole;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            const Vec3 from = patch.point(i, j) - line_.o;
            open[0].x[4 * i + j] = dot(from, line_.side);
            open[0].y[4 * i + j] = dot(from, line_.up);
            open[0].s[4 * i + j] = dot(from, line_.along);
        }
    }
    const double e = line_.error;
    for (int looked = 0; count > 0; ++looked) {
        Seen& at = open[count - 1];
        if (missed(at, e)) {
            --count;
            continue;
        }
        const auto slopes =
            slopes_of([&](std::size_t i, std::size_t j) { return at.point(4 * i + j); });
        FreeformCone du, dv;
        if (cone_of(slopes.du, du) && cone_of(slopes.dv, dv) && turn_one_way(du, dv) &&
            solve(number, at.part, du, dv, 0.5 * (at.part.u0 + at.part.u1),
                  0.5 * (at.part.v0 + at.part.v1)) == Answer::done) {
            --count;
            continue;
        }
        Vec2 longest_u, longest_v;
        const double along_u = longest(slopes.du, longest_u);
        const double along_v = longest(slopes.dv, longest_v);
        const bool even = along_u <= kEven * along_v && along_v <= kEven * along_u;
        const bool thin = width(at, along_u >= along_v ? longest_u : longest_v) <= e &&
                          (even || along_u + along_v <= e);
        if (thin || looked >= kMostParts || count == kMostHalvings) {
            const auto [lo, hi] = std::minmax_element(at.s.begin(), at.s.end());
            found_.doubt({*lo - e, *hi + e, false});
            --count;
            continue;
        }
        halve(at, along_u >= along_v, open[count]);
        ++count;
    }
}

void FreeformSearch::run() {
    const Slabs slabs(line_.o, line_.along, line_.error);
    std::array<std::uint32_t, kMostFreeformWaiting> open;
    std::size_t count = 1;
    open[0] = 0;
    while (count > 0) {
        const FreeformNode& node = surface_.nodes[open[--count]];
        for (unsigned met = slabs.met(node.boxes); met != 0; met &= met - 1) {
            const std::uint32_t child = node.child[__builtin_ctz(met)];
            if ((child & FreeformNode::kLeaf) != 0) {
                meet(surface_.leaves[child & ~FreeformNode::kLeaf]);
            } else {
                open[count++] = child;
            }
        }
    }
}

}  // namespace raymo::solids
