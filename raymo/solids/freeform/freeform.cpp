#include "raymo/solids/freeform/freeform.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "raymo/solids/ray_block.hpp"

namespace raymo::solids {
namespace {

/// Sizes whose products are still numbers.
constexpr double kLeastSize = 1e-90, kMostSize = 1e90;

/// Derivatives smaller than this, of a patch about as large as 1, are taken for those where a border has shrunk.
constexpr double kShrunk = 1e-8;

/// By how much a point that is asked for its normal may miss its patch, far more than any error.
constexpr double kBesidePatch = 0x1p-10;

double squared(Vec3 a) { return dot(a, a); }

/// The place in the plane of a and b that is nearest to `from`; false where they span none.
bool in_plane(Vec3 from, Vec3 a, Vec3 b, double& x, double& y) {
    const double aa = dot(a, a), ab = dot(a, b), bb = dot(b, b);
    const double det = aa * bb - ab * ab;
    if (!(det > 1e-24 * (aa + bb) * (aa + bb))) return false;
    const double pa = dot(from, a), pb = dot(from, b);
    x = (pa * bb - pb * ab) / det;
    y = (pb * aa - pa * ab) / det;
    return true;
}

/// From a border that has shrunk to a point, as far inwards as p is away, to the side where p is.
void leave_pole(const Patch& patch, Vec3 p, double& u, double& v) {
    const PatchJet jet = patch.at(u, v);
    const bool along_u = squared(jet.du) <= squared(jet.dv);
    const double speed = norm(along_u ? jet.dv : jet.du);
    if (!(speed > 0.0)) return;
    double& across = along_u ? v : u;
    double& along = along_u ? u : v;
    const double step = std::min(norm(p - jet.at) / speed, 0.5);
    across += across < 0.5 ? step : -step;
    double least = std::numeric_limits<double>::infinity();
    double best = along;
    for (int i = 0; i <= 8; ++i) {
        along = i / 8.0;
        const double distance = squared(p - patch.at(u, v).at);
        if (!(distance < least)) continue;
        least = distance;
        best = along;
    }
    along = best;
}

/// The place of a patch that is nearest to p, from the nearest of its leaves on, by steps to that of its tangent plane.
void nearest_place(const FreeformSurface& surface, std::uint32_t number, Vec3 p, double& u,
                   double& v) {
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = surface.first_leaf[number]; i < surface.first_leaf[number + 1]; ++i) {
        const FreeformLeaf& leaf = surface.leaves[i];
        // What is not near cannot be nearest, for p is next to the patch.
        const double near = leaf.reach + kBesidePatch;
        if (squared(p - leaf.middle) > near * near) continue;
        double x = 0.0, y = 0.0;
        if (!in_plane(p - leaf.middle, leaf.du, leaf.dv, x, y)) x = y = 0.0;
        x = std::clamp(x, -0.5, 0.5);
        y = std::clamp(y, -0.5, 0.5);
        const double distance = squared(p - leaf.middle - leaf.du * x - leaf.dv * y);
        if (!(distance < least)) continue;
        least = distance;
        u = leaf.part.u0 + (x + 0.5) * (leaf.part.u1 - leaf.part.u0);
        v = leaf.part.v0 + (y + 0.5) * (leaf.part.v1 - leaf.part.v0);
    }
    const Patch& patch = surface.patches[number];
    bool left = false;
    for (int i = 0; i < 16; ++i) {
        const PatchJet jet = patch.at(u, v);
        double x = 0.0, y = 0.0;
        if (!in_plane(p - jet.at, jet.du, jet.dv, x, y)) {
            if (left) return;
            left = true;
            leave_pole(patch, p, u, v);
            continue;
        }
        const double next_u = std::clamp(u + x, 0.0, 1.0);
        const double next_v = std::clamp(v + y, 0.0, 1.0);
        const double step = std::max(std::fabs(next_u - u), std::fabs(next_v - v));
        u = next_u;
        v = next_v;
        // From a place of the surface itself each step squares what is missing.
        if (step < 1e-6) return;
    }
}

Vec3 mixed_derivative(const Patch& patch, double u, double v) {
    const CubicWeights by_u(u), by_v(v);
    Vec3 sum;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j)
            sum += patch.point(i, j) * (by_u.slope[i] * by_v.slope[j]);
    }
    return sum;
}

/// Next to a border along u that has shrunk to a point, S_u = (v - v0) S_uv, with v0 = 0 or 1; and so for v.
Vec3 normal_at(const Patch& patch, double u, double v) {
    const PatchJet jet = patch.at(u, v);
    Vec3 du = jet.du;
    Vec3 dv = jet.dv;
    if (squared(du) < kShrunk * kShrunk) du = mixed_derivative(patch, u, v) * (v < 0.5 ? 1 : -1);
    if (squared(dv) < kShrunk * kShrunk) dv = mixed_derivative(patch, u, v) * (u < 0.5 ? 1 : -1);
    return cross(du, dv);
}

/// n.b_ij of a part of a patch, halved until it is known how large it becomes.
struct Heights {
    std::array<double, 16> h;

    [[nodiscard]] double most() const { return *std::max_element(h.begin(), h.end()); }
    [[nodiscard]] double at_corners() const {
        return std::max(std::max(h[0], h[3]), std::max(h[12], h[15]));
    }
    /// How much it bends along i (stride 4) or j (stride 1).
    [[nodiscard]] double bend(std::size_t stride, std::size_t across) const {
        double most = 0.0;
        for (std::size_t n = 0; n < 4; ++n) {
            const std::size_t k = n * across;
            for (std::size_t m = 0; m < 2; ++m) {
                const std::size_t at = k + m * stride;
                most = std::max(most, std::fabs(h[at] - 2.0 * h[at + stride] + h[at + 2 * stride]));
            }
        }
        return most;
    }
    void halve(std::size_t stride, std::size_t across, Heights& other) {
        for (std::size_t n = 0; n < 4; ++n) {
            double* c = h.data() + n * across;
            double* d = other.h.data() + n * across;
            const double c0 = c[0], c1 = c[stride], c2 = c[2 * stride], c3 = c[3 * stride];
            const double a = 0.5 * (c0 + c1), m = 0.5 * (c1 + c2), b = 0.5 * (c2 + c3);
            const double am = 0.5 * (a + m), mb = 0.5 * (m + b);
            c[stride] = a;
            c[2 * stride] = am;
            c[3 * stride] = d[0] = 0.5 * (am + mb);
            d[stride] = mb;
            d[2 * stride] = b;
            d[3 * stride] = c3;
        }
    }
};

/// The largest n.x of the surface, never too small. Parts that may reach higher than what is known are halved; where there
/// are too many, for the largest is reached along a curve, their control points are taken.
double reach(const FreeformSurface& surface, Vec3 n) {
    constexpr int kMostParts = 20000;
    double best = -std::numeric_limits<double>::infinity();
    std::vector<Heights> open;
    for (const meshes::Net& net : surface.shell.patches) {
        Heights at;
        for (std::size_t k = 0; k < 16; ++k) at.h[k] = dot(n, surface.shell.points[net[k]]);
        best = std::max(best, at.at_corners());
        if (at.most() > best) open.push_back(at);
    }
    const double enough = 0x1p-50 * (std::fabs(n.x) + std::fabs(n.y) + std::fabs(n.z));
    double left = best;
    for (int looked = 0; !open.empty(); ++looked) {
        Heights at = open.back();
        open.pop_back();
        const double most = at.most();
        if (most <= best + enough || looked >= kMostParts) {
            left = std::max(left, most);
            continue;
        }
        Heights other;
        if (at.bend(4, 1) >= at.bend(1, 4)) {
            at.halve(4, 1, other);
        } else {
            at.halve(1, 4, other);
        }
        best = std::max(best, std::max(at.at_corners(), other.at_corners()));
        // The higher one first.
        if (at.most() > other.most()) std::swap(at, other);
        open.push_back(at);
        open.push_back(other);
    }
    return std::max(best, left);
}

}  // namespace

Aabb Freeform::bounds(const Affine& map) const {
    Aabb box;
    for (int i = 0; i < 3; ++i) {
        const Vec3 n = map.linear.row[static_cast<std::size_t>(i)];
        box.hi[i] = map.offset[i] + reach(*surface_, n);
        box.lo[i] = map.offset[i] - reach(*surface_, -n);
    }
    return box;
}

Vec3 Freeform::normal(Vec3 p, std::uint16_t face) const {
    std::uint32_t number = face / 2U;
    double u = 0.5, v = 0.5;
    nearest_place(*surface_, number, p, u, v);
    const auto distance = [&](std::uint32_t of, double at_u, double at_v) {
        return squared(p - surface_->patches[of].at(at_u, at_v).at);
    };
    for (std::uint32_t other = number + kPatchNumbers; other < surface_->patches.size();
         other += kPatchNumbers) {
        double other_u = 0.5, other_v = 0.5;
        nearest_place(*surface_, other, p, other_u, other_v);
        if (!(distance(other, other_u, other_v) < distance(number, u, v))) continue;
        number = other, u = other_u, v = other_v;
    }
    const Patch& patch = surface_->patches[number];
    const auto good = [](Vec3 n) { return squared(n) > 1e-200; };
    Vec3 n = normal_at(patch, u, v);
    // Where two borders have shrunk that share a corner, the inside of the patch tells.
    for (double inwards = 1e-6; !good(n) && inwards < 1.0; inwards *= 8.0)
        n = normal_at(patch, u + (0.5 - u) * inwards, v + (0.5 - v) * inwards);
    if (!good(n)) return {0.0, 0.0, 1.0};
    return (face & kInsideOut) != 0 ? -n : n;
}

void Freeform::normals(PlaceBlock& places, std::uint32_t asked) const {
    for (std::uint32_t rest = asked; rest != 0; rest &= rest - 1) {
        const int i = __builtin_ctz(rest);
        const Vec3 n = normal({places.p[0][i], places.p[1][i], places.p[2][i]},
                              static_cast<std::uint16_t>(places.face[i]));
        for (int a = 0; a < 3; ++a) places.p[a][i] = n[a];
    }
}

std::span<const std::string_view> Freeform::faces() const {
    static constexpr std::array<std::string_view, 1> kFaces{"patch"};
    return kFaces;
}

double Freeform::volume() const { return meshes::volume_of(surface_->shell); }

Result<Placed<Freeform>> frame_shell(const meshes::Shell& shell) {
    if (shell.patches.size() > kMostPatches) {
        Failure failure =
            fail(ErrorCode::limit,
                 "the surface has " + std::to_string(shell.patches.size()) + " patches, and " +
                     std::to_string(kMostPatches) + " are the most",
                 "use a coarser mesh, or make it of several solids");
        return failure;
    }
    Aabb box;
    for (const meshes::Net& net : shell.patches) {
        for (const std::uint32_t k : net) box.include(shell.points[k]);
    }
    const double size = 0.5 * max_norm(box.size());
    if (!(size > kLeastSize && size < kMostSize) || !is_finite(box.lo) || !is_finite(box.hi)) {
        return fail(ErrorCode::out_of_range,
                    "the surface is too large or too small to be computed with", "use other units");
    }
    const int exponent = std::ilogb(size) + 1;
    const double scale = std::ldexp(1.0, -exponent);
    const Vec3 centre = box.lo * 0.5 + box.hi * 0.5;
    auto surface = std::make_shared<FreeformSurface>();
    surface->shell = shell;
    for (Vec3& p : surface->shell.points) p = (p - centre) * scale;
    surface->finish();
    const double unit = std::ldexp(1.0, exponent);
    Affine map = scaling({unit, unit, unit});
    map.offset = centre;
    return Placed<Freeform>{Freeform(std::move(surface)), map};
}

}  // namespace raymo::solids
