// The judge of free-form solids: how often the surface winds around a point, by crossings of a half-line that are looked for
// in every small part of every patch by Newton's steps in wide numbers; nothing of the kernel's own search.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "raymo/solids/freeform/freeform.hpp"
#include "raymo/solids/test_quad.hpp"

namespace raymo::solids::conformance {

class WindingJudge {
public:
    using Real = long double;

    WindingJudge(const meshes::Shell& shell, Real x, Real y, Real z) : shell_(shell), p_{x, y, z} {}

    /// Of p. False: not clear along enough half-lines.
    [[nodiscard]] bool winding(int& out) {
        static constexpr double kDirections[][3] = {
            {0.6123, 0.3411, 0.7101},  {-0.2939, 0.8713, 0.3917}, {0.4421, -0.3187, 0.8387},
            {0.1733, 0.6011, -0.7801}, {-0.7717, 0.1313, 0.6221}, {0.5309, 0.8087, -0.2531},
            {0.9281, 0.2173, 0.3019},  {-0.5147, -0.5897, 0.621}};
        // Newton's steps may pass by a pair of crossings, so two half-lines must agree.
        bool has_one = false;
        int one = 0;
        for (const auto& d : kDirections) {
            if (!along(d[0], d[1], d[2], out)) continue;
            if (has_one && out == one) return true;
            has_one = true;
            one = out;
        }
        return false;
    }

private:
    struct Root {
        Real u, v, t;
        int sign;
    };

    bool along(Real x, Real y, Real z, int& out) {
        const Real length = std::sqrt(x * x + y * y + z * z);
        w_[0] = x / length, w_[1] = y / length, w_[2] = z / length;
        // Any two directions across.
        const Real n = std::sqrt(w_[0] * w_[0] + w_[1] * w_[1]);
        a_[0] = -w_[1] / n, a_[1] = w_[0] / n, a_[2] = 0;
        b_[0] = -w_[2] * a_[1], b_[1] = w_[2] * a_[0], b_[2] = w_[0] * a_[1] - w_[1] * a_[0];
        int before = 0, after = 0;
        for (const meshes::Net& net : shell_.patches) {
            if (passes_by(net)) continue;
            roots_.clear();
            if (!patch(net)) return false;
            for (const Root& root : roots_) (root.t > 0 ? after : before) += root.sign;
        }
        // The half-line leaves what the surface winds around; all crossings of the line add up to nothing.
        out = after;
        return before + after == 0;
    }

    /// Whether the line misses the ball about the control points.
    bool passes_by(const meshes::Net& net) const {
        Aabb box;
        for (const meshes::Index k : net) box.include(shell_.points[k]);
        const Vec3 c = box.centre();
        const double radius = 0.5 * norm(box.size()) * (1 + 1e-12) + 1e-12 * max_norm(c);
        const Real d[3] = {c.x - p_[0], c.y - p_[1], c.z - p_[2]};
        Real a = 0, b = 0;
        for (int i = 0; i < 3; ++i) a += d[i] * a_[i], b += d[i] * b_[i];
        return a * a + b * b > Real(radius) * radius;
    }

    bool patch(const meshes::Net& net) {
        struct Cell {
            double x[16], y[16];
            double u, v, size;
        };
        Cell whole;
        whole.u = whole.v = 0;
        whole.size = 1;
        for (std::size_t k = 0; k < 16; ++k) {
            const Vec3 q = shell_.points[net[k]];
            Real c[3] = {q.x - p_[0], q.y - p_[1], q.z - p_[2]};
            for (int i = 0; i < 3; ++i) c_[i][k] = c[i];
            whole.x[k] = double(c[0] * a_[0] + c[1] * a_[1] + c[2] * a_[2]);
            whole.y[k] = double(c[0] * b_[0] + c[1] * b_[1] + c[2] * b_[2]);
        }
        std::vector<Cell> open{whole};
        while (!open.empty()) {
            const Cell at = open.back();
            open.pop_back();
            const auto misses = [](const double(&f)[16]) {
                return *std::min_element(f, f + 16) > 1e-12 ||
                       *std::max_element(f, f + 16) < -1e-12;
            };
            if (misses(at.x) || misses(at.y)) continue;
            if (at.size <= 1.0 / 16) {
                const int found = newton(at.u + at.size / 2, at.v + at.size / 2);
                if (found < 0) return false;
                if (at.size <= 1.0 / 64) continue;
            }
            // Into four.
            Cell parts[4];
            for (int n = 0; n < 4; ++n) {
                parts[n].size = at.size / 2;
                parts[n].u = at.u + (n & 1 ? at.size / 2 : 0);
                parts[n].v = at.v + (n & 2 ? at.size / 2 : 0);
            }
            quarter(at.x, parts[0].x, parts[1].x, parts[2].x, parts[3].x);
            quarter(at.y, parts[0].y, parts[1].y, parts[2].y, parts[3].y);
            for (const Cell& part : parts) open.push_back(part);
        }
        return true;
    }

    static void halve(const double* c, int step, double* lo, double* hi) {
        const double a = (c[0] + c[step]) / 2, m = (c[step] + c[2 * step]) / 2,
                     b = (c[2 * step] + c[3 * step]) / 2;
        const double am = (a + m) / 2, mb = (m + b) / 2, mid = (am + mb) / 2;
        const double left[4] = {c[0], a, am, mid}, right[4] = {mid, mb, b, c[3 * step]};
        for (int i = 0; i < 4; ++i) lo[i * step] = left[i], hi[i * step] = right[i];
    }
    static void quarter(const double (&c)[16], double (&p00)[16], double (&p10)[16],
                        double (&p01)[16], double (&p11)[16]) {
        double lo[16], hi[16];
        for (int j = 0; j < 4; ++j) halve(c + j, 4, lo + j, hi + j);
        for (int i = 0; i < 4; ++i) {
            halve(lo + 4 * i, 1, p00 + 4 * i, p01 + 4 * i);
            halve(hi + 4 * i, 1, p10 + 4 * i, p11 + 4 * i);
        }
    }

    static void weights(Real u, Real (&f)[4], Real (&g)[4]) {
        const Real w = 1 - u;
        f[0] = w * w * w, f[1] = 3 * w * w * u, f[2] = 3 * w * u * u, f[3] = u * u * u;
        g[0] = -3 * w * w, g[1] = 3 * w * w - 6 * w * u, g[2] = 6 * w * u - 3 * u * u,
        g[3] = 3 * u * u;
    }

    /// From there to a crossing, if there is one near. -1: one that is not clear.
    int newton(Real u, Real v) {
        for (int step = 0; step < 12; ++step) {
            Real fu[4], gu[4], fv[4], gv[4];
            weights(u, fu, gu);
            weights(v, fv, gv);
            Real s[3] = {}, du[3] = {}, dv[3] = {};
            for (int i = 0; i < 3; ++i) {
                for (int k = 0; k < 16; ++k) {
                    s[i] += fu[k / 4] * fv[k % 4] * c_[i][k];
                    du[i] += gu[k / 4] * fv[k % 4] * c_[i][k];
                    dv[i] += fu[k / 4] * gv[k % 4] * c_[i][k];
                }
            }
            const auto dot3 = [](const Real(&p)[3], const Real(&q)[3]) {
                return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
            };
            const Real x = dot3(s, a_), y = dot3(s, b_);
            const Real xu = dot3(du, a_), yu = dot3(du, b_);
            const Real xv = dot3(dv, a_), yv = dot3(dv, b_);
            const Real det = xu * yv - xv * yu;
            if (det == 0) return 0;
            const Real step_u = -(x * yv - y * xv) / det;
            const Real step_v = -(xu * y - yu * x) / det;
            const Real size = std::max(std::fabs(step_u), std::fabs(step_v));
            if (!(size < 4)) return 0;
            u += step_u;
            v += step_v;
            if (u < -0.5L || u > 1.5L || v < -0.5L || v > 1.5L) return 0;
            if (size > 1e-13L) continue;
            const Real border = std::min(std::min(u, 1 - u), std::min(v, 1 - v));
            if (border < -1e-7L) return 0;
            if (border < 1e-7L) return -1;
            const Real n[3] = {du[1] * dv[2] - du[2] * dv[1], du[2] * dv[0] - du[0] * dv[2],
                               du[0] * dv[1] - du[1] * dv[0]};
            const Real slope = dot3(n, w_) / std::sqrt(dot3(n, n));
            if (!(std::fabs(slope) > 0.003L)) return -1;
            for (const Root& root : roots_) {
                if (std::fabs(root.u - u) < 1e-9L && std::fabs(root.v - v) < 1e-9L) return 1;
            }
            const Real t = dot3(s, w_) + dot3(du, w_) * step_u + dot3(dv, w_) * step_v;
            roots_.push_back({u, v, t, slope > 0 ? 1 : -1});
            return 1;
        }
        return 0;
    }

    const meshes::Shell& shell_;
    Real p_[3];
    Real w_[3], a_[3], b_[3];
    Real c_[3][16];
    std::vector<Root> roots_;
};

/// 0 where the judge can not tell.
inline Quad field(const Freeform& k, const QuadPoint& p) {
    int winding = 0;
    WindingJudge judge(k.surface().shell, static_cast<long double>(p.x),
                       static_cast<long double>(p.y), static_cast<long double>(p.z));
    if (!judge.winding(winding)) return 0;
    return winding != 0 ? -1 : 1;
}

/// Lines along the borders of patches, through their corners, along their diagonals and in their tangent planes.
template <class Random>
void aim(const Freeform& k, Random& random, Vec3& p, Vec3& d) {
    const FreeformSurface& surface = k.surface();
    const auto place = [&] {
        const Patch& patch =
            surface.patches[static_cast<std::size_t>(random.below(int(surface.patches.size())))];
        const auto parameter = [&] {
            return random.chance(0.5) ? 0.5 * random.below(3) : random.uniform(0, 1);
        };
        return patch.at(parameter(), parameter());
    };
    const PatchJet first = place();
    const PatchJet second = place();
    p = first.at;
    switch (random.below(5)) {
        case 0:
            d = first.du * random.uniform(-1, 1) + first.dv * random.uniform(-1, 1);
            break;
        case 1:
            d = random.chance(0.5) ? first.du : first.dv;
            break;
        case 2:
            d = first.du + first.dv * (random.chance(0.5) ? 1.0 : -1.0);
            break;
        case 3:
            d = random.direction();
            break;
        default:
            d = second.at - first.at;
    }
    if (max_norm(d) > 0.0) d = unit(d);
}

}  // namespace raymo::solids::conformance
