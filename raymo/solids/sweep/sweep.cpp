#include "raymo/solids/sweep/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "raymo/curves/roots.hpp"
#include "raymo/math/tolerance.hpp"

namespace raymo::solids {
namespace {

constexpr std::size_t kPath = 0, kCaps = 1;
constexpr std::size_t kFlat = 1;

/// Sizes whose squares and products are still numbers.
constexpr double kLeastSize = 1e-140, kMostSize = 1e140;

Failure refuse(ErrorCode code, std::size_t argument, const char* message, const char* hint,
               const char* label) {
    Failure failure = fail(code, message, hint);
    failure.value().label = label;
    failure.value().argument = static_cast<int>(argument);
    return failure;
}

bool is_finite(const Cubics& q) {
    for (const auto& point : q.c) {
        for (const double x : point) {
            if (!std::isfinite(x)) return false;
        }
    }
    return true;
}

/// The radius' least value, and the largest.
double least_radius(const Cubics& q) {
    Cubics turned = q;
    for (auto& point : turned.c) point[3] = -point[3];
    return -reach(turned, {}, 1.0);
}
double most_radius(const Cubics& q) { return reach(q, {}, 1.0); }

/// q in the frame that is moved by `centre` and smaller by the power of two `scale`.
Cubics normalised(const Cubics& q, Vec3 centre, double scale) {
    Cubics out;
    for (std::size_t i = 0; i < 4; ++i) {
        for (int k = 0; k < 3; ++k) {
            const auto at = static_cast<std::size_t>(k);
            out.c[i][at] = (q.c[i][at] - centre[k]) * scale;
        }
        out.c[i][3] = std::fabs(q.c[i][3] * scale) > 0.0 ? q.c[i][3] * scale : 0.0;
    }
    return out;
}

Cubics reversed(const Cubics& q) {
    Cubics out = q;
    std::reverse(out.c.begin(), out.c.end());
    return out;
}

/// The plane across the path at its first ball; none where the balls there have no envelope.
bool cap_plane(const std::vector<SweptSpan>& spans, bool from_last, CapPlane& out) {
    for (std::size_t s = 0; s < spans.size(); ++s) {
        const Cubics& given = spans[from_last ? spans.size() - 1 - s : s].cubics;
        const Cubics q = from_last ? reversed(given) : given;
        for (std::size_t i = 1; i < 4; ++i) {
            Vec3 along;
            for (int k = 0; k < 3; ++k) {
                const auto at = static_cast<std::size_t>(k);
                along[k] = q.c[i][at] - q.c[0][at];
            }
            const double growth = q.c[i][3] - q.c[0][3];
            const double length = norm(along);
            if (length == 0.0 && growth == 0.0) continue;
            if (!(std::fabs(growth) < length)) return false;
            out.n = along / length;
            out.c = dot(out.n, {q.c[0][0], q.c[0][1], q.c[0][2]}) - q.c[0][3] * (growth / length);
            return true;
        }
    }
    return false;
}

/// Marks the balls that a flat cap cuts, from the path's end until one is beside the plane; cuts a span there.
void mark_cut(std::vector<SweptSpan>& spans, bool from_last, const CapPlane& plane) {
    const auto bit = static_cast<std::uint8_t>(from_last ? 2 : 1);
    if (from_last) std::reverse(spans.begin(), spans.end());
    for (std::size_t s = 0; s < spans.size(); ++s) {
        const Cubics q = from_last ? reversed(spans[s].cubics) : spans[s].cubics;
        std::array<double, 4> height;
        for (std::size_t i = 0; i < 4; ++i) {
            height[i] = plane.n.x * q.c[i][0] + plane.n.y * q.c[i][1] + plane.n.z * q.c[i][2] -
                        plane.c - q.c[i][3];
        }
        if (height[0] >= 0.0) break;
        curves::RootList<3> roots;
        curves::find_roots<3>(height, 0.0, roots);
        const curves::Root* first = nullptr;
        for (const curves::Root& root : roots) {
            if (first == nullptr && root.crosses && root.rises) first = &root;
        }
        if (first != nullptr && first->u > 0.0 && first->u < 1.0) {
            Cubics near, far;
            split(q, first->u, near, far);
            SweptSpan rest = spans[s];
            rest.cubics = from_last ? reversed(far) : far;
            spans[s].cubics = from_last ? reversed(near) : near;
            spans[s].cut |= bit;
            spans.insert(spans.begin() + static_cast<std::ptrdiff_t>(s) + 1, rest);
            break;
        }
        spans[s].cut |= bit;
    }
    if (from_last) std::reverse(spans.begin(), spans.end());
}

}  // namespace

std::span<const std::string_view> Sweep::Kernel::faces() const {
    static constexpr std::array<std::string_view, 3> kFaces{"side", "start", "end"};
    return std::span(kFaces).first(spheres_->closed ? 1 : 3);
}

const Schema& Sweep::schema() {
    static constexpr std::array<std::string_view, 2> kCapWords{"round", "flat"};
    static const std::array<Param, 2> kParams{
        Param{.name = "path",
              .words = "path",
              .kind = ParamKind::path,
              .doc = "where the ball runs, and its radius on the way"},
        Param{.name = "caps",
              .words = "caps",
              .kind = ParamKind::choice,
              .doc = "how open ends are closed: by the ball itself, or across the path",
              .fallback = std::size_t{0},
              .choices = kCapWords}};
    static const Schema kSchema{
        "sweep", "All that a ball touches that runs along a path; its radius may change.", kParams,
        "let hook = path([(0, 0, 0, 2), (0, 0, 24, 2), (20, 0, 28, 5), (30, 0, 4, 4), (12, 0, 0, "
        "1)],\n"
        "                ends: \"clamped\")\n"
        "sweep(hook).paint(\"slateblue\")"};
    return kSchema;
}

Result<Placed<Sweep::Kernel>> Sweep::prepare(std::span<const Argument> arguments) {
    const curves::PathPtr& path = std::get<curves::PathPtr>(arguments[kPath]);
    if (path == nullptr || path->spans.empty()) {
        return refuse(ErrorCode::bad_argument, kPath, "sweep: its path has no spans",
                      "give a path of two points or more", "this path is empty");
    }
    Aabb box;
    double most = 0.0;
    double least = 0.0;
    for (const curves::PathSpan& span : path->spans) {
        const Cubics q = cubics_of(span);
        const Aabb part = box_of(q);
        if (!is_finite(q) || !raymo::is_finite(part.lo) || !raymo::is_finite(part.hi)) {
            return refuse(ErrorCode::out_of_range, kPath,
                          "sweep: its path must be of finite numbers",
                          "move its points nearer to the origin", "this path reaches too far");
        }
        box = hull(box, part);
        most = std::max(most, most_radius(q));
        least = std::min(least, least_radius(q));
    }
    // Cubics of rounded coefficients may pass 0 by as much.
    if (least < -16.0 * kUnitRoundoff * most) {
        return refuse(ErrorCode::out_of_range, kPath,
                      "sweep: the radius must be at least 0 everywhere", "give larger radii",
                      "the radius of this path becomes negative");
    }
    if (!(most > 0.0)) {
        return refuse(ErrorCode::out_of_range, kPath, "sweep: the radius must not be 0 everywhere",
                      "give a positive radius", "the radius of this path is 0");
    }
    const double size = 0.5 * max_norm(box.size());
    if (!(size > kLeastSize && size < kMostSize)) {
        return refuse(ErrorCode::out_of_range, kPath,
                      "sweep: its path is too large or too small to be computed with",
                      "use other units",
                      size > 1.0 ? "this path is too large" : "this path is too small");
    }

    auto spheres = std::make_shared<SweptSpheres>();
    const int exponent = std::ilogb(size) + 1;
    const double scale = std::ldexp(1.0, -exponent);
    const Vec3 centre = box.lo * 0.5 + box.hi * 0.5;
    for (const curves::PathSpan& span : path->spans)
        spheres->spans.push_back({normalised(cubics_of(span), centre, scale), 0});
    spheres->closed = path->closed;
    spheres->flat = !path->closed && std::get<std::size_t>(arguments[kCaps]) == kFlat;
    if (spheres->flat) {
        for (const bool from_last : {false, true}) {
            if (cap_plane(spheres->spans, from_last, spheres->caps[from_last ? 1 : 0])) continue;
            return refuse(ErrorCode::out_of_range, kCaps,
                          from_last
                              ? "sweep: its end cannot be flat, for the radius changes there as "
                                "fast as the path moves"
                              : "sweep: its start cannot be flat, for the radius changes there "
                                "as fast as the path moves",
                          "use caps: \"round\"", "this is \"flat\"");
        }
        for (const bool from_last : {false, true})
            mark_cut(spheres->spans, from_last, spheres->caps[from_last ? 1 : 0]);
    }
    spheres->finish();
    const double unit = std::ldexp(1.0, exponent);
    Affine map = scaling({unit, unit, unit});
    map.offset = centre;
    return Placed<Kernel>{Kernel(std::move(spheres)), map};
}

}  // namespace raymo::solids
