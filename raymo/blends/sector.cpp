#include "raymo/blends/sector.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "raymo/blends/make.hpp"

namespace raymo::blends {
namespace {

/// How far the ruled surfaces may pass the contacts by, as part of the radius.
constexpr double kContact = 0x1p-16;
/// A piece of the path turns by no more than this. [radians]
constexpr double kMostTurn = 0.375;
/// Halvings of a coarse piece, and pieces in all.
constexpr int kMostHalvings = 12;
constexpr std::size_t kMostPieces = 2048;

/// How the chains are made: of so many cubics each, and how deep beyond the faces, as part of the radius. A face that bends much
/// along the section asks for many or for much depth, a thin solid for little.
struct Chains {
    std::size_t arcs;
    double depth;
};
constexpr Chains kChains[] = {{1, 0x1p-5}, {1, 0x1p-8}, {2, 0x1p-6}, {2, 0x1p-10}, {4, 0x1p-12}};

/// A sector: the centre, and then the control points of the chain's cubics, from behind contact a to behind the edge and
/// on to behind contact b.
using Section = std::vector<Vec3>;

struct Place {
    Station station;
    Section corners;
};

class Sweeper {
public:
    Sweeper(const Spine& spine, Chains chains) : spine_(spine), chains_(chains) {}

    /// The sides between places, and both ends unless it is a ring. False: not with these chains.
    [[nodiscard]] bool run(const std::vector<Station>& coarse, bool is_ring) {
        Place from;
        if (!place(coarse[0], from)) return false;
        const Place first = from;
        for (std::size_t i = 1; i < coarse.size(); ++i) {
            Place to;
            if (is_ring && i + 1 == coarse.size()) {
                to = first;
                to.station.t = coarse[i].t;
            } else if (!place(coarse[i], to)) {
                return false;
            }
            if (!pieces(from, to)) return false;
            from = std::move(to);
        }
        if (!is_ring) {
            add_end(first.corners);
            add_end(from.corners);
        }
        return true;
    }
    [[nodiscard]] std::vector<meshes::GivenNet> take() { return std::move(nets_); }

private:
    [[nodiscard]] double depth() const { return chains_.depth * spine_.radius(); }
    /// The distance of a point beyond face a or b: positive where the wedge is not.
    [[nodiscard]] double beyond(std::size_t which, Vec3 p) const {
        return -spine_.segment().sign() * spine_.side(which) * spine_.surface(which).distance(p);
    }

    [[nodiscard]] bool place(const Station& station, Place& out) const {
        out.station = station;
        const std::size_t n = chains_.arcs;
        out.corners.assign(6 * n + 2, station.centre);
        const Segment& segment = spine_.segment();
        const Vec3 edge = segment.point(station.t);
        Vec3 behind = edge;
        const double s = -segment.sign() * depth();
        if (!to_distances(spine_.surface(0), s * spine_.side(0), spine_.surface(1),
                          s * spine_.side(1), segment.tangent(station.t), behind)) {
            return false;
        }
        for (std::size_t which = 0; which < 2; ++which) {
            const auto corner = [&](std::size_t k) -> Vec3& {
                return out.corners[which == 0 ? 1 + k : 6 * n + 1 - k];
            };
            const Vec3 contact = station.contact[which];
            // Along the face in a plane through contact and edge: unit, towards the edge.
            const Vec3 across = cross(spine_.surface(which).normal(contact), edge - contact);
            const auto way_at = [&](Vec3 p) {
                return unit(cross(across, spine_.surface(which).normal(p)));
            };
            corner(0) = contact + (contact - station.centre) * chains_.depth;
            corner(3 * n) = behind;
            for (std::size_t k = 1; k < n; ++k) {
                Vec3& p = corner(3 * k);
                p = contact + (edge - contact) * (static_cast<double>(k) / static_cast<double>(n));
                if (!to_depth(which, unit(across), p)) return false;
            }
            for (std::size_t k = 0; k < n; ++k) {
                const Vec3 p = corner(3 * k);
                const Vec3 q = corner(3 * k + 3);
                const Vec3 from = way_at(p);
                const Vec3 to = way_at(q);
                const double handle = round_handle(p, from, q, to);
                corner(3 * k + 1) = p + from * handle;
                corner(3 * k + 2) = q - to * handle;
            }
        }
        return station.speed_of(out.corners[1]) > 0.0 && station.speed_of(out.corners.back()) > 0.0;
    }
    /// Moves a point to its depth beyond a face, in the plane across a direction.
    [[nodiscard]] bool to_depth(std::size_t which, Vec3 across, Vec3& p) const {
        const Surface& surface = spine_.surface(which);
        for (int i = 0; i < 20; ++i) {
            const double off = depth() - beyond(which, p);
            if (std::fabs(off) <= 0x1p-10 * depth()) return true;
            const Vec3 n = surface.normal(p) * (-spine_.segment().sign() * spine_.side(which));
            const Vec3 within = n - across * dot(n, across);
            p = p + within * (off / dot(within, within));
            if (!is_finite(p)) return false;
        }
        return false;
    }

    [[nodiscard]] bool pieces(const Place& from, const Place& to) {
        struct Piece {
            Place from, to;
            int halvings;
        };
        std::vector<Piece> open{{from, to, 0}};
        while (!open.empty()) {
            Piece piece = std::move(open.back());
            open.pop_back();
            if (add(piece.from, piece.to)) continue;
            if (piece.halvings == kMostHalvings || count_ == kMostPieces) return false;
            const auto middle = spine_.at(0.5 * (piece.from.station.t + piece.to.station.t));
            Place between;
            if (!middle || !place(*middle, between)) return false;
            open.push_back({between, std::move(piece.to), piece.halvings + 1});
            open.push_back({std::move(piece.from), std::move(between), piece.halvings + 1});
        }
        return true;
    }

    /// Adds the piece between two places, unless it is too long for what happens there.
    [[nodiscard]] bool add(const Place& from, const Place& to) {
        const Station& a = from.station;
        const Station& b = to.station;
        if (!(dot(a.tangent, b.tangent) > std::cos(kMostTurn)) || !follows(from, to)) return false;
        const Cubic path = path_between(a, b);
        const auto beside = spine_.between(a, b, value_at(path, 0.5));
        const auto found = spine_.at(0.5 * (a.t + b.t));
        Place middle;
        if (!beside || !found || !place(*found, middle) || !follows(from, middle) ||
            !follows(middle, to) || !is_steady(from, middle, to)) {
            return false;
        }
        const std::size_t n = from.corners.size();
        std::vector<Cubic> lines(n);
        lines[0] = path;
        const double ahead = norm(path[1] - path[0]);
        const double behind = norm(path[3] - path[2]);
        for (std::size_t k = 1; k < n; ++k) {
            const Vec3 p = from.corners[k];
            const Vec3 q = to.corners[k];
            if (k == 1 || k + 1 == n) {
                const std::size_t which = k == 1 ? 0 : 1;
                const double out = 1.0 + chains_.depth;
                const Vec3 way_p = a.tangent + (a.way[which] - a.tangent) * out;
                const Vec3 way_q = b.tangent + (b.way[which] - b.tangent) * out;
                lines[k] = {p, p + way_p * ahead, q - way_q * behind, q};
                if (!meets(path, lines[k], *beside, which)) return false;
            } else {
                // The parabola through all three.
                const Vec3 pull = middle.corners[k] * 2.0 - (p + q) * 0.5;
                lines[k] = {p, (p + pull * 2.0) / 3.0, (q + pull * 2.0) / 3.0, q};
            }
        }
        for (const double u : {0.25, 0.5, 0.75}) {
            if (!is_beyond(lines, u)) return false;
        }
        const auto ruled = [&](const Cubic& l, const Cubic& r) {
            add_net([&](std::size_t i, std::size_t j) { return part(l[i], r[i], j); });
        };
        ruled(lines[0], lines[1]);
        for (std::size_t k = 1; k + 1 < n; k += 3) {
            add_net([&](std::size_t i, std::size_t j) { return lines[k + j][i]; });
        }
        ruled(lines[n - 1], lines[0]);
        ++count_;
        return true;
    }

    /// Whether the ruled surfaces run ahead, as seen from both places.
    [[nodiscard]] static bool follows(const Place& from, const Place& to) {
        const auto is_ahead = [&](Vec3 p, Vec3 q) {
            return dot(q - p, from.station.tangent) > 0.0 && dot(q - p, to.station.tangent) > 0.0;
        };
        return is_ahead(from.corners[0], to.corners[0]) &&
               is_ahead(from.corners[1], to.corners[1]) &&
               is_ahead(from.corners.back(), to.corners.back());
    }
    /// Whether their speeds change so little that they do not turn back unseen.
    [[nodiscard]] static bool is_steady(const Place& from, const Place& middle, const Place& to) {
        for (const std::size_t k : {std::size_t{1}, from.corners.size() - 1}) {
            const double v[3] = {from.station.speed_of(from.corners[k]),
                                 middle.station.speed_of(middle.corners[k]),
                                 to.station.speed_of(to.corners[k])};
            const double least = std::min({v[0], v[1], v[2]});
            const double most = std::max({v[0], v[1], v[2]});
            if (!(most - least <= 2.0 * least)) return false;
        }
        return true;
    }
    /// Whether the ruled surface between two lines meets the contact at the middle.
    [[nodiscard]] bool meets(const Cubic& path, const Cubic& line, const Station& middle,
                             std::size_t which) const {
        const Vec3 c = value_at(path, 0.5);
        const Vec3 out = unit(value_at(line, 0.5) - c);
        const Vec3 d = middle.contact[which] - c;
        // Along the path it does not matter.
        Vec3 off = d - out * dot(d, out);
        off = off - middle.tangent * dot(off, middle.tangent);
        return norm(off) <= kContact * spine_.radius();
    }
    /// Whether the chains at u are beyond the faces, and within what they bound.
    [[nodiscard]] bool is_beyond(const std::vector<Cubic>& lines, double u) const {
        const double least = 2.0 * kBeyond * spine_.radius();
        for (std::size_t k = 0; k < 2 * chains_.arcs; ++k) {
            const std::size_t which = k < chains_.arcs ? 0 : 1;
            Cubic arc;
            for (std::size_t j = 0; j < 4; ++j) arc[j] = value_at(lines[1 + 3 * k + j], u);
            for (const double v : {0.0, 0.125, 0.25, 0.5, 0.75, 0.875, 1.0}) {
                if (!(beyond(which, value_at(arc, v)) > least)) return false;
            }
        }
        return true;
    }

    static Vec3 part(Vec3 a, Vec3 b, std::size_t thirds) {
        return thirds == 3 ? b : a + (b - a) * (static_cast<double>(thirds) / 3.0);
    }
    template <class F>
    void add_net(F&& point) {
        meshes::GivenNet net;
        for (std::size_t k = 0; k < 16; ++k) net[k] = point(k / 4, k % 4);
        nets_.push_back(net);
    }
    /// A fan of triangles about the centre.
    void add_end(const Section& corners) {
        for (std::size_t k = 1; k + 1 < corners.size(); k += 3) {
            add_net(
                [&](std::size_t i, std::size_t j) { return part(corners[0], corners[k + j], i); });
        }
    }

    const Spine& spine_;
    Chains chains_;
    std::vector<meshes::GivenNet> nets_;
    std::size_t count_ = 0;
};

}  // namespace

Result<csg::Solid> sector_solid(const Spine& spine, double lo, double hi, SourceSpan span) {
    const auto coarse = coarse_stations(spine, lo, hi);
    if (!coarse.empty()) {
        for (const Chains& chains : kChains) {
            Sweeper sweeper(spine, chains);
            if (!sweeper.run(coarse, spine.is_ring(lo, hi))) continue;
            return make<solids::Patches>(
                {std::make_shared<const std::vector<meshes::GivenNet>>(sweeper.take()),
                 std::size_t{0}},
                span);
        }
    }
    return fail(ErrorCode::out_of_range, "the edge bends too sharply for this ball");
}

}  // namespace raymo::blends
