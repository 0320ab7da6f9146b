// Patches of a refined mesh.
//
// Regular faces. Where a face has four sides and each of its corners four edges, refinement converges to a uniform bicubic
// B-spline. Beside a sharp edge it does, too, with points beyond the edge that are mirrored, P_-1 = 2 P_0 - P_1. Of a face at
// the point V, with the edges to E and E' and the point F across, the control points next to V are
//     inside the patch       (4 V + 2 E + 2 E' + F) / 9,
//     on the edge to E       (8 V + 4 E + 2 E' + 2 E'' + F + F'') / 18, E'' and F'' being in the face across that edge,
//     at V                   (16 V + 4 sum E + sum F) / 36,
// and on creases those of a cubic B-spline.
//
// Other points, where n edges meet. Two steps of refinement leave no two of them near each other. The patches around such a point v
// are made to have the same tangent planes across their borders: for each spoke i, an edge from v to the regular point w_i, let
// beta_i be the control point beyond w_i. With c = cos(2 pi / n), and
//     p   = (n^2 V + 4 sum E + sum F) / (n (n + 5)), the place of v in the limit,
//     m_i = p + lambda q_i, where the q_i are an affine image of a regular n-gon, in the tangent plane of the limit:
//     q_i = (2 / n) sum_j [ (1 - sigma cos(pi / n)) cos(2 pi (j - i) / n) M_j + 2 sigma cos((2 pi (j - i) + pi) / n) C_j ],
//     sigma = (4 + cos^2(pi / n))^(-1/2),  lambda = (5 + c + cos(pi / n) sqrt(18 + 2 c)) / 16,
// M_j being middles of edges and C_j of faces [LoopSchaefer08],
//     m_{i-1} + m_{i+1} - 2 p = 2 c (m_i - p).                                                                  (1)
// The spoke becomes the parabola C with the control points p, m_i and w_i' = (2 m_i + 3 beta_i) / 5: so it goes on beyond w_i
// with the same derivative. What w_i moves by moves the control points to both sides of it, too, and the inner ones beside the
// spoke are mirrored from those beyond. The derivatives P, Q across the spoke on both sides shall satisfy, with u from v,
//     P + Q = 2 c (1 - u)^2 C'(u),
// which makes the tangent planes one. C' being linear, both sides are cubics; their four coefficients agree, in turn, by (1);
// if the inner control points x_i next to v satisfy
//     x_{i-1} + x_i = 2 (p / 3 + 2 m_i / 3) + (4 c / 9) (w_i' - m_i);                                           (2)
// and the last two by what has been done at w_i. (2) is a cyclic system: for odd n it has one solution; for even n it has one
// only if sum (-1)^i w_i' = 0, for which the beta_i are moved, with the control points beside them, by the alternating mean;
// and of the solutions, which differ by +-x, the one nearest to (n V + 2 E + 2 E' + F) / (n + 5) is taken.
//
// Beside creases the faces from one sharp edge at v to the next are a fan of k, with spokes 0 and k on the creases, which stay
// what they are; (1) and (2) hold for those between, with c = cos theta, k theta being the angle of the fan: half a turn where a
// crease passes through v, for which regular fans have k = 2; a quarter turn at corners, for which k = 1 is regular. (2)
// then leaves one x_i free in any case.
//
// Where one crease ends at v (a dart), p and all m_i are those of a smooth point, so v has one tangent plane; the fan goes round
// all faces, from the crease to the crease again: k = n, a full turn. So the normals of both sides of the crease become one
// as it comes to v.
//
#include "raymo/meshes/smooth.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "raymo/meshes/refine.hpp"

namespace raymo::meshes {
namespace {

using std::numbers::pi;

Failure refuse(ErrorCode code, std::string message, std::string hint) {
    Failure failure = fail(code, std::move(message), std::move(hint));
    failure.value().argument = 0;
    return failure;
}

/// Control points of the patches of a mesh whose faces have four sides.
class Patches {
public:
    Patches(const Mesh& mesh, const Topology& topology)
        : mesh_(mesh),
          topology_(topology),
          sharp_(sharp_valences(mesh)),
          at_point_(mesh.points.size()),
          on_edge_(mesh.corners.size()),
          inside_(mesh.corners.size()) {}

    [[nodiscard]] Shell shell() {
        std::vector<Index> special;
        for (Index p = 0; p < mesh_.points.size(); ++p) {
            if (topology_.leaving[p] == 0xffffffffU) continue;
            start(p);
            if (!is_regular(p)) special.push_back(p);
        }
        for (const Index p : special) {
            if (sharp_[p] == 0) {
                join_all(p);
            } else if (sharp_[p] == 1) {
                join_round_crease(p);
            } else {
                join_fans(p);
            }
        }
        return collect();
    }

    /// Of a face of four sides.
    [[nodiscard]] bool is_regular(Index p) const {
        const std::vector<Index> spokes = spokes_of(p);
        const std::size_t n = spokes.size();
        if (sharp_[p] == 0) return n == 4;
        std::vector<std::size_t> at;
        for (std::size_t i = 0; i < n; ++i) {
            if (is_sharp(spokes[i])) at.push_back(i);
        }
        if (sharp_[p] == 1) return false;
        const std::size_t wanted = sharp_[p] == 2 ? 2 : 1;
        for (std::size_t i = 0; i < at.size(); ++i) {
            const std::size_t next = i + 1 < at.size() ? at[i + 1] : at[0] + n;
            if (next - at[i] != wanted) return false;
        }
        return true;
    }

private:
    [[nodiscard]] Vec3 from(Index s) const { return mesh_.points[mesh_.corners[s]]; }
    [[nodiscard]] Vec3 to(Index s) const { return from(topology_.next[s]); }
    /// Across the face of s from the point that s leaves.
    [[nodiscard]] Vec3 opposite(Index s) const { return from(topology_.next[topology_.next[s]]); }
    [[nodiscard]] bool is_sharp(Index s) const {
        return mesh_.is_crease(mesh_.corners[s], mesh_.corners[topology_.next[s]]);
    }
    [[nodiscard]] std::vector<Index> spokes_of(Index p) const {
        std::vector<Index> out;
        Index s = topology_.leaving[p];
        do {
            out.push_back(s);
            s = topology_.around(s);
        } while (s != topology_.leaving[p]);
        return out;
    }

    /// Control points as refinement has them, in the limit or nearly.
    void start(Index p) {
        const std::vector<Index> spokes = spokes_of(p);
        const std::size_t n = spokes.size();
        const Vec3 v = mesh_.points[p];
        const bool is_smooth = sharp_[p] < 2;
        const double weight = is_smooth ? static_cast<double>(n) : 4.0;
        for (std::size_t i = 0; i < n; ++i) {
            const Index s = spokes[i];
            const Index t = spokes[(i + 1) % n];
            inside_[s] = (v * weight + to(s) * 2.0 + to(t) * 2.0 + opposite(s)) / (weight + 5.0);
        }
        if (is_smooth) {
            start_smooth(p, spokes);
            return;
        }
        Vec3 ends;
        for (const Index s : spokes) {
            if (!is_sharp(s)) continue;
            on_edge_[s] = (v * 2.0 + to(s)) / 3.0;
            ends += to(s);
        }
        at_point_[p] = sharp_[p] == 2 ? (ends + v * 4.0) / 6.0 : v;
        // Between two creases, as if its fan were regular.
        for (std::size_t i = 0; i < n; ++i) {
            const Index s = spokes[i];
            if (is_sharp(s)) continue;
            const Index before = spokes[(i + n - 1) % n];
            on_edge_[s] =
                at_point_[p] * (2.0 / 3.0) + (opposite(before) + to(s) * 4.0 + opposite(s)) / 18.0;
        }
    }

    void start_smooth(Index p, const std::vector<Index>& spokes) {
        const std::size_t count = spokes.size();
        const auto n = static_cast<double>(count);
        const Vec3 v = mesh_.points[p];
        Vec3 edges, faces;
        for (const Index s : spokes) {
            edges += to(s);
            faces += opposite(s);
        }
        const Vec3 place = (v * (n * n) + edges * 4.0 + faces) / (n * (n + 5.0));
        at_point_[p] = place;
        if (count == 4) {
            for (std::size_t i = 0; i < 4; ++i) {
                const Index s = spokes[i];
                const Index left = spokes[(i + 1) % 4];
                const Index right = spokes[(i + 3) % 4];
                on_edge_[s] = (v * 8.0 + to(s) * 4.0 + (to(left) + to(right)) * 2.0 + opposite(s) +
                               opposite(right)) /
                              18.0;
            }
            return;
        }
        const double c = std::cos(2.0 * pi / n);
        const double half = std::cos(pi / n);
        const double sigma = 1.0 / std::sqrt(4.0 + half * half);
        const double lambda = (5.0 + c + half * std::sqrt(18.0 + 2.0 * c)) / 16.0;
        // The n-gon is spanned by its cosine and its sine.
        Vec3 a, b;
        for (std::size_t j = 0; j < count; ++j) {
            const Index s = spokes[j];
            const double turn = 2.0 * pi * static_cast<double>(j) / n;
            const Vec3 middle = (v + to(s)) * 0.5 - v;
            const Vec3 centre = (v + to(s) + opposite(s) + to(spokes[(j + 1) % count])) * 0.25 - v;
            a += middle * ((1.0 - sigma * half) * std::cos(turn)) +
                 centre * (2.0 * sigma * std::cos(turn + pi / n));
            b += middle * ((1.0 - sigma * half) * std::sin(turn)) +
                 centre * (2.0 * sigma * std::sin(turn + pi / n));
        }
        for (std::size_t i = 0; i < count; ++i) {
            const double turn = 2.0 * pi * static_cast<double>(i) / n;
            const Vec3 q = (a * std::cos(turn) + b * std::sin(turn)) * (2.0 / n);
            on_edge_[spokes[i]] = place + q * (lambda * 2.0 / 3.0);
        }
    }

    /// Sides at the regular point at the other end of a spoke: back along it, to its left, on, to its right.
    struct Far {
        Index back, left, on, right;
    };
    [[nodiscard]] Far far_of(Index spoke) const {
        Far out{};
        out.back = topology_.twin[spoke];
        out.left = topology_.around(out.back);
        out.on = topology_.around(out.left);
        out.right = topology_.around(out.on);
        return out;
    }

    /// Makes a spoke the parabola to m, and what is at its other end fit it.
    void lay(Index spoke, Vec3 place, Vec3 m, Vec3 moved) {
        const Far w = far_of(spoke);
        const Index point = mesh_.corners[w.back];
        on_edge_[w.on] += moved;
        inside_[w.left] += moved;
        inside_[w.on] += moved;
        const Vec3 end = (m * 2.0 + on_edge_[w.on] * 3.0) / 5.0;
        const Vec3 shift = end - at_point_[point];
        at_point_[point] = end;
        on_edge_[w.left] += shift;
        on_edge_[w.right] += shift;
        on_edge_[spoke] = (place + m * 2.0) / 3.0;
        on_edge_[w.back] = (end + m * 2.0) / 3.0;
        inside_[w.back] = on_edge_[w.left] * 2.0 - inside_[w.left];
        inside_[w.right] = on_edge_[w.right] * 2.0 - inside_[w.on];
    }

    /// The right side of (2).
    [[nodiscard]] Vec3 sum_beside(Index spoke, Vec3 place, Vec3 m, double c) const {
        const Vec3 end = at_point_[mesh_.corners[topology_.twin[spoke]]];
        return (place + m * 2.0) * (2.0 / 3.0) + (end - m) * (4.0 * c / 9.0);
    }

    void join_all(Index p) {
        const std::vector<Index> spokes = spokes_of(p);
        const std::size_t n = spokes.size();
        const Vec3 place = at_point_[p];
        const double c = std::cos(2.0 * pi / static_cast<double>(n));
        const auto sign = [](std::size_t i) { return i % 2 == 0 ? 1.0 : -1.0; };
        std::vector<Vec3> m(n), sum(n), x(n);
        for (std::size_t i = 0; i < n; ++i) m[i] = place + (on_edge_[spokes[i]] - place) * 1.5;
        Vec3 uneven;
        if (n % 2 == 0) {
            for (std::size_t i = 0; i < n; ++i)
                uneven += on_edge_[far_of(spokes[i]).on] * (sign(i) / static_cast<double>(n));
        }
        for (std::size_t i = 0; i < n; ++i) lay(spokes[i], place, m[i], uneven * -sign(i));
        for (std::size_t i = 0; i < n; ++i) sum[i] = sum_beside(spokes[i], place, m[i], c);
        // x_{i-1} + x_i = sum_i
        if (n % 2 == 1) {
            for (std::size_t j = 0; j < n; ++j) x[0] += sum[(n - j) % n] * (0.5 * sign(j));
        }
        for (std::size_t i = 1; i < n; ++i) x[i] = sum[i] - x[i - 1];
        if (n % 2 == 0) {
            Vec3 off;
            for (std::size_t i = 0; i < n; ++i)
                off += (inside_[spokes[i]] - x[i]) * (sign(i) / static_cast<double>(n));
            for (std::size_t i = 0; i < n; ++i) x[i] += off * sign(i);
        }
        for (std::size_t i = 0; i < n; ++i) inside_[spokes[i]] = x[i];
    }

    void join_fans(Index p) {
        const std::vector<Index> spokes = spokes_of(p);
        const std::size_t n = spokes.size();
        for (std::size_t first = 0; first < n; ++first) {
            if (!is_sharp(spokes[first])) continue;
            std::vector<Index> fan{spokes[first]};
            do {
                fan.push_back(spokes[(first + fan.size()) % n]);
            } while (!is_sharp(fan.back()));
            const std::size_t regular = sharp_[p] == 2 ? 2 : 1;
            if (fan.size() - 1 > regular || (fan.size() == 3 && sharp_[p] > 2)) join_fan(p, fan);
        }
    }

    void join_fan(Index p, const std::vector<Index>& fan) {
        const std::size_t k = fan.size() - 1;
        const Vec3 place = at_point_[p];
        const bool passes = sharp_[p] == 2;
        const double theta = (passes ? pi : 0.5 * pi) / static_cast<double>(k);
        const auto start = [&](Index s) { return (on_edge_[s] - place) * 1.5; };
        const Vec3 a = start(fan[0]);
        Vec3 b;  // at a right angle to a, in the n-gon's own terms
        if (passes) {
            for (std::size_t i = 1; i < k; ++i)
                b += start(fan[i]) *
                     (2.0 / static_cast<double>(k) * std::sin(theta * static_cast<double>(i)));
        } else {
            b = start(fan[k]);
        }
        const auto turned = [&](std::size_t i) {
            const double angle = theta * static_cast<double>(i);
            return place + a * std::cos(angle) + b * std::sin(angle);
        };
        std::vector<Vec3> m(k);
        for (std::size_t i = 1; i < k; ++i) m[i] = turned(i);
        join_between(fan, place, m, std::cos(theta));
    }

    void join_round_crease(Index p) {
        std::vector<Index> fan = spokes_of(p);
        std::rotate(fan.begin(),
                    std::find_if(fan.begin(), fan.end(), [&](Index s) { return is_sharp(s); }),
                    fan.end());
        const std::size_t n = fan.size();
        const Vec3 place = at_point_[p];
        std::vector<Vec3> m(n);
        for (std::size_t i = 1; i < n; ++i) m[i] = place + (on_edge_[fan[i]] - place) * 1.5;
        join_between(fan, place, m, std::cos(2.0 * pi / static_cast<double>(n)));
    }

    /// Joins the faces of a fan across its spokes but the first; m holds the points m_i of these, and c = cos theta.
    void join_between(const std::vector<Index>& fan, Vec3 place, const std::vector<Vec3>& m,
                      double c) {
        const std::size_t k = m.size();
        const auto sign = [](std::size_t i) { return i % 2 == 0 ? 1.0 : -1.0; };
        std::vector<Vec3> x(k);
        for (std::size_t i = 1; i < k; ++i) lay(fan[i], place, m[i], Vec3{});
        for (std::size_t i = 1; i < k; ++i) x[i] = sum_beside(fan[i], place, m[i], c) - x[i - 1];
        Vec3 off;
        for (std::size_t i = 0; i < k; ++i)
            off += (inside_[fan[i]] - x[i]) * (sign(i) / static_cast<double>(k));
        for (std::size_t i = 0; i < k; ++i) inside_[fan[i]] = x[i] + off * sign(i);
    }

    [[nodiscard]] Shell collect() const {
        const auto points = static_cast<Index>(at_point_.size());
        const auto sides = static_cast<Index>(on_edge_.size());
        Shell out;
        out.points = at_point_;
        out.points.insert(out.points.end(), on_edge_.begin(), on_edge_.end());
        out.points.insert(out.points.end(), inside_.begin(), inside_.end());
        const auto on = [&](Index s) { return points + s; };
        const auto in = [&](Index s) { return points + sides + s; };
        for (Index f = 0; f < mesh_.face_count(); ++f) {
            const Index s = mesh_.first[f];
            const auto& twin = topology_.twin;
            const auto at = [&](Index i) { return mesh_.corners[s + i]; };
            // u from corner 0 to 1, v from 0 to 3.
            out.patches.push_back({at(0), on(twin[s + 3]), on(s + 3), at(3),      //
                                   on(s), in(s), in(s + 3), on(twin[s + 2]),      //
                                   on(twin[s]), in(s + 1), in(s + 2), on(s + 2),  //
                                   at(1), on(s + 1), on(twin[s + 1]), at(2)});
        }
        return out;
    }

    const Mesh& mesh_;
    const Topology& topology_;
    std::vector<Index> sharp_;
    std::vector<Vec3> at_point_;  ///< of each point
    std::vector<Vec3> on_edge_;   ///< of each side: on its edge, next to where it begins
    std::vector<Vec3> inside_;    ///< of each side: within its face, next to where it begins
};

/// Only patches with four sides, and points that B-splines know.
bool is_regular(const Mesh& mesh, const Topology& topology) {
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        if (mesh.face(f).size() != 4) return false;
    }
    const Patches patches(mesh, topology);
    for (Index p = 0; p < mesh.points.size(); ++p) {
        if (topology.leaving[p] != 0xffffffffU && !patches.is_regular(p)) return false;
    }
    return true;
}

}  // namespace

Result<Shell> smooth(const Mesh& given) {
    if (given.face_count() > kMostSmoothPatches) {
        return refuse(ErrorCode::limit,
                      "the mesh has " + std::to_string(given.face_count()) +
                          " faces, too many to be smoothed",
                      "smooth a coarse mesh: it describes a finer surface than its faces show");
    }
    auto topology = close(given);
    if (!topology) return Failure(std::move(topology).error());
    Mesh mesh = given;
    const double volume = volume6(mesh);
    const double size = max_norm(box_of(mesh).size());
    if (!(std::fabs(volume) > 1e-12 * size * size * size)) {
        return refuse(ErrorCode::bad_argument, "the mesh bounds no volume",
                      "give it some thickness");
    }
    if (volume < 0.0) {
        mesh = turned_round(std::move(mesh));
        topology = close(mesh);
        if (!topology) return Failure(std::move(topology).error());
    }
    if (!is_regular(mesh, *topology)) {
        if (4 * mesh.corners.size() > kMostSmoothPatches) {
            return refuse(ErrorCode::limit,
                          "the mesh has " + std::to_string(given.face_count()) +
                              " faces, too many to be smoothed",
                          "smooth a coarse mesh: it describes a finer surface than its faces show");
        }
        for (int step = 0; step < 2; ++step) {
            mesh = refined(mesh, *topology);
            topology = close(mesh);
            if (!topology) return Failure(std::move(topology).error());
        }
    }
    return Patches(mesh, *topology).shell();
}

}  // namespace raymo::meshes
