#include "raymo/blends/sector.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "raymo/blends/far_side.hpp"
#include "raymo/blends/make.hpp"
#include "raymo/blends/near_side.hpp"

namespace raymo::blends {
namespace {

/// A piece of the path turns by no more than this. [radians]
constexpr double kMostTurn = 0.375;
/// Halvings of a coarse piece, and pieces in all.
constexpr int kMostHalvings = 12;
constexpr std::size_t kMostPieces = 2048;
/// Patches in all. Halving costs less patches in vain than it makes, unless it does not help: then so many more.
constexpr std::size_t kMostPatches = 0x10000;
constexpr std::size_t kMostInVain = 0x1000;

/// What curves across a conic may be off by, as part of what its patches may be: stations between those looked at may ask for more.
constexpr double kParts[] = {0x1p-2, 0x1p-5};

constexpr Chains kChains[] = {{1, 0x1p-5}, {1, 0x1p-8}, {2, 0x1p-6}, {2, 0x1p-10}, {4, 0x1p-12}};

struct Place {
    Station station;
    NearPlace near;
    FarPlace far;
};

class Sweeper {
public:
    Sweeper(const Spine& spine, const NearSide& near, Chains chains)
        : spine_(spine), near_(near), far_(spine, chains) {}

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
            add_end(first);
            add_end(from);
        }
        return true;
    }
    /// Whether it was the near side that could not be followed in the end: no other chains will help.
    [[nodiscard]] bool is_near_lost() const { return is_near_lost_; }
    [[nodiscard]] std::vector<meshes::GivenNet> take() { return std::move(nets_); }

private:
    [[nodiscard]] bool place(const Station& station, Place& out) {
        out.station = station;
        is_near_lost_ = !near_.place(station, out.near);
        if (is_near_lost_) return false;
        const auto& [end_a, end_b] = out.near.ends;
        return far_.place(station, end_a, end_b, out.far) && station.speed_of(end_a) > 0.0 &&
               station.speed_of(end_b) > 0.0;
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
            const std::size_t before = nets_.size();
            if (add(piece.from, piece.to)) continue;
            nets_.resize(before);
            in_vain_ += std::max<std::size_t>(piece.from.near.across.size(), 1);
            if (piece.halvings == kMostHalvings || count_ == kMostPieces ||
                nets_.size() > kMostPatches || in_vain_ > kMostInVain + 2 * nets_.size()) {
                return false;
            }
            const auto middle = spine_.at(0.5 * (piece.from.station.t + piece.to.station.t));
            Place between;
            if (!middle || !place(*middle, between)) return false;
            open.push_back({between, std::move(piece.to), piece.halvings + 1});
            open.push_back({std::move(piece.from), std::move(between), piece.halvings + 1});
        }
        return true;
    }

    /// Adds the piece between two places. False: it is too long for what happens there.
    [[nodiscard]] bool add(const Place& from, const Place& to) {
        const Station& a = from.station;
        const Station& b = to.station;
        if (!(dot(a.tangent, b.tangent) > std::cos(kMostTurn)) || !follows(from, to)) return false;
        const auto found = spine_.at(0.5 * (a.t + b.t));
        Place middle;
        if (!found || !place(*found, middle) || !follows(from, middle) || !follows(middle, to) ||
            !is_steady(from, middle, to)) {
            return false;
        }
        Cubic ends[2];
        is_near_lost_ = !near_.append(a, from.near, *found, middle.near, b, to.near, ends, nets_);
        if (is_near_lost_) return false;
        const std::size_t n = from.far.size();
        std::vector<Cubic> lines(n);
        lines[0] = ends[0];
        lines[n - 1] = ends[1];
        for (std::size_t k = 1; k + 1 < n; ++k)
            lines[k] = parabola(from.far[k], middle.far[k], to.far[k]);
        for (const double u : {0.25, 0.5, 0.75}) {
            if (!far_.is_beyond(lines, u)) return false;
        }
        for (std::size_t k = 0; k < far_.arcs(); ++k) {
            meshes::GivenNet net;
            for (std::size_t i = 0; i < 16; ++i) net[i] = lines[3 * k + i % 4][i / 4];
            nets_.push_back(net);
        }
        ++count_;
        return true;
    }

    /// Whether the near side runs ahead, as seen from both places.
    [[nodiscard]] static bool follows(const Place& from, const Place& to) {
        const auto is_ahead = [&](Vec3 p, Vec3 q) {
            return dot(q - p, from.station.tangent) > 0.0 && dot(q - p, to.station.tangent) > 0.0;
        };
        return is_ahead(from.station.centre, to.station.centre) &&
               is_ahead(from.near.ends[0], to.near.ends[0]) &&
               is_ahead(from.near.ends[1], to.near.ends[1]);
    }
    /// Whether their speeds change so little that they do not turn back unseen.
    [[nodiscard]] static bool is_steady(const Place& from, const Place& middle, const Place& to) {
        for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
            const auto speed = [&](const Place& at) {
                return at.station.speed_of(at.near.ends[k]);
            };
            const double v[3] = {speed(from), speed(middle), speed(to)};
            const double least = std::min({v[0], v[1], v[2]});
            const double most = std::max({v[0], v[1], v[2]});
            if (!(most - least <= 2.0 * least)) return false;
        }
        return true;
    }

    /// A fan about the centre of a ball, of a profile about the edge.
    void add_end(const Place& at) {
        const Vec3 tip =
            at.near.across.empty() ? at.station.centre : spine_.segment().point(at.station.t);
        const auto add_part = [&](const Cubic& rim) {
            nets_.push_back(ruled({tip, tip, tip, tip}, rim));
        };
        for (const Cubic& arc : at.near.across) add_part(arc);
        for (std::size_t k = 0; k < far_.arcs(); ++k)
            add_part({at.far[3 * k], at.far[3 * k + 1], at.far[3 * k + 2], at.far[3 * k + 3]});
    }

    const Spine& spine_;
    const NearSide& near_;
    FarSide far_;
    std::vector<meshes::GivenNet> nets_;
    std::size_t count_ = 0;
    std::size_t in_vain_ = 0;
    bool is_near_lost_ = false;
};

Failure too_sharp() {
    return fail(ErrorCode::out_of_range, "the edge bends too sharply for this ball");
}

}  // namespace

Result<csg::Solid> sector_solid(const Spine& spine, const Form& form, double lo, double hi,
                                SourceSpan span) {
    const auto coarse = coarse_stations(spine, lo, hi);
    if (!coarse.empty()) {
        const bool is_conic = form.profile == Profile::conic;
        for (const double part : kParts) {
            for (const Chains& chains : kChains) {
                const auto near = form.profile == Profile::ball
                                      ? ball_side(spine, chains.depth)
                                      : profile_side(spine, form, chains.depth, coarse, part);
                // It can not be followed at all then.
                if (!near) return too_sharp();
                Sweeper sweeper(spine, *near, chains);
                if (!sweeper.run(coarse, spine.is_ring(lo, hi))) {
                    if (is_conic && sweeper.is_near_lost()) break;
                    continue;
                }
                return make<solids::Patches>(
                    {std::make_shared<const std::vector<meshes::GivenNet>>(sweeper.take()),
                     std::size_t{0}},
                    span);
            }
            if (!is_conic) break;
        }
    }
    return too_sharp();
}

}  // namespace raymo::blends
