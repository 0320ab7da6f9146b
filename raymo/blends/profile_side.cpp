#include <algorithm>
#include <cmath>

#include "raymo/blends/near_side.hpp"

namespace raymo::blends {
namespace {

/// How far patches may be off, as part of the radius.
constexpr double kChamfer = 0x1p-30;
constexpr double kConic = 0x1p-28;
/// Strips of a conic, and halvings of its parameter.
constexpr std::size_t kMostStrips = 96;
constexpr int kMostHalvings = 30;
/// A conic's bends are looked at in at most so many places.
constexpr std::size_t kMostLooks = 64;

class ProfileSide final : public NearSide {
public:
    ProfileSide(const Spine& spine, const Form& form, double depth)
        : spine_(spine),
          curve_(spine, form, depth * spine.radius()),
          allowed_(std::max((form.profile == Profile::chamfer ? kChamfer : kConic) * form.radius,
                            spine.rounding())) {}

    /// Cuts a conic into strips whose curves across are off by `part` of what patches may be. False: it can not be followed.
    [[nodiscard]] bool cut(const std::vector<Station>& coarse, double part) {
        breaks_ = {0.0};
        met_.clear();
        off_.clear();
        // From the last to the first: what is yet to be looked at.
        struct Open {
            double to;
            int halvings;
        };
        std::vector<Open> open{{1.0, 0}};
        while (!open.empty()) {
            const double from = breaks_.back();
            const double to = open.back().to;
            if (is_flat(coarse, from, to, part * allowed_)) {
                const auto at = [&](double v) { return curve_.part(from, to, v); };
                for (std::size_t l = 0; l + 1 < kPlaces.size(); ++l) met_.push_back(at(kPlaces[l]));
                for (const double v : kSeen) off_.push_back(at(v));
                breaks_.push_back(to);
                open.pop_back();
                continue;
            }
            const int halvings = ++open.back().halvings;
            if (halvings > kMostHalvings || breaks_.size() + open.size() > kMostStrips)
                return false;
            open.push_back({curve_.part(from, to, 0.5), halvings});
        }
        met_.push_back(1.0);
        return true;
    }

    bool place(const Station& station, NearPlace& out) const override {
        const auto ends = curve_.ends(station);
        out.points.clear();
        if (!ends || !curve_.append_points(station, met_, out.points)) return false;
        out.ends[0] = ends->a;
        out.ends[1] = ends->b;
        out.across.clear();
        if (curve_.is_straight()) {
            out.across.push_back(straight(ends->a, ends->b));
            return true;
        }
        out.across.push_back(straight(ends->a, out.points.front()));
        for (std::size_t s = 0; s < strips(); ++s)
            out.across.push_back(arc(station, places_of(out.points, s)));
        out.across.push_back(straight(out.points.back(), ends->b));
        return true;
    }

    bool append(const Station& a, const NearPlace& from, const Station& middle,
                const NearPlace& middle_near, const Station& b, const NearPlace& to, Cubic ends[2],
                std::vector<meshes::GivenNet>& nets) const override {
        static_cast<void>(middle);
        const Cubic path = path_between(a, b);
        std::array<std::vector<Vec3>, kPlaces.size()> rows;
        rows.front() = from.points;
        rows.back() = to.points;
        for (std::size_t k = 1; k + 1 < rows.size(); ++k) {
            const auto station = spine_.between(a, b, value_at(path, kPlaces[k]));
            if (!station || !curve_.append_points(*station, met_, rows[k])) return false;
        }
        std::array<std::vector<Vec3>, kBetween.size()> seen;
        for (std::size_t k = 0; k < seen.size(); ++k) {
            const auto station = spine_.between(a, b, value_at(path, kBetween[k]));
            if (!station || !curve_.append_points(*station, off_, seen[k])) return false;
        }
        const std::size_t first = curve_.is_straight() ? 0 : 1;
        Cubic lo, hi;
        for (std::size_t s = 0; s < strips(); ++s) {
            Grid points;
            for (std::size_t k = 0; k < points.size(); ++k) points[k] = places_of(rows[k], s);
            const LocalGrid grid = local_grid(points);
            const auto line_at = [&](std::size_t l) {
                LocalLine line;
                for (std::size_t k = 0; k < line.size(); ++k) line[k] = grid[k][l];
                return cubic_through(line);
            };
            lo = s == 0 ? line_at(0) : hi;
            hi = line_at(kPlaces.size() - 1);
            if (s == 0) ends[0] = lo;
            const Borders borders{from.across[first + s], to.across[first + s], lo, hi};
            const meshes::GivenNet net = patch_through(borders, grid);
            for (std::size_t k = 0; k < seen.size(); ++k) {
                for (std::size_t l = 0; l < std::size(kSeen); ++l) {
                    const Vec3 there = seen[k][s * std::size(kSeen) + l];
                    if (!is_near(local_patch(net, kBetween[k], kSeen[l]), there, allowed_))
                        return false;
                }
            }
            nets.push_back(net);
        }
        ends[1] = hi;
        if (first == 1) {
            const Cubic wall_a = parabola(from.ends[0], middle_near.ends[0], to.ends[0]);
            const Cubic wall_b = parabola(from.ends[1], middle_near.ends[1], to.ends[1]);
            nets.push_back(ruled(wall_a, ends[0]));
            nets.push_back(ruled(ends[1], wall_b));
            ends[0] = wall_a;
            ends[1] = wall_b;
        }
        return true;
    }

private:
    /// Where across a strip it is looked whether a patch is on the surface: at its borders and where it is off by most.
    static constexpr double kSeen[] = {0.0,         kBetween[0], kBetween[1], kBetween[2],
                                       kBetween[3], kBetween[4], 1.0};

    [[nodiscard]] std::size_t strips() const { return breaks_.size() - 1; }
    static Cubic straight(Vec3 p, Vec3 q) {
        return {p, p + (q - p) / 3.0, p + (q - p) * (2.0 / 3.0), q};
    }
    static Places places_of(const std::vector<Vec3>& points, std::size_t strip) {
        Places out;
        for (std::size_t l = 0; l < out.size(); ++l) out[l] = points[(out.size() - 1) * strip + l];
        return out;
    }
    /// In the plane across the path.
    static Cubic arc(const Station& station, const Places& p) {
        return cubic_through(local_line(p, station.tangent));
    }
    /// Whether one arc is enough from one parameter to another at all stations.
    [[nodiscard]] bool is_flat(const std::vector<Station>& stations, double from, double to,
                               double allowed) const {
        if (curve_.is_straight()) return true;
        std::vector<double> at;
        for (const double v : kPlaces) at.push_back(curve_.part(from, to, v));
        for (const double v : kBetween) at.push_back(curve_.part(from, to, v));
        std::sort(at.begin(), at.end());
        const std::size_t stride = 1 + stations.size() / kMostLooks;
        std::vector<Vec3> points;
        for (std::size_t i = 0; i < stations.size(); i += stride) {
            points.clear();
            if (!curve_.append_points(stations[i], at, points)) return false;
            // They take turns.
            Places met;
            for (std::size_t k = 0; k < met.size(); ++k) met[k] = points[2 * k];
            const Cubic c = arc(stations[i], met);
            // Upright on the plane.
            const Vec3 up = stations[i].tangent * norm(c[3] - c[0]);
            for (std::size_t k = 0; k < kBetween.size(); ++k) {
                if (!is_near(local_cubic(c, up, kBetween[k]), points[2 * k + 1], allowed))
                    return false;
            }
        }
        return true;
    }
    /// Whether a patch (or arc) is on the surface next to a point of that.
    [[nodiscard]] static bool is_near(const LocalSurface& patch, Vec3 there, double allowed) {
        const auto offset = patch.offset(there);
        const double size = std::max(norm(patch.along), norm(patch.across));
        return std::fabs(offset.off) <= allowed &&
               norm(patch.along * offset.u + patch.across * offset.v) <= kSlide * size;
    }

    const Spine& spine_;
    ProfileCurve curve_;
    double allowed_;              ///< how far patches may be off [mm]
    std::vector<double> breaks_;  ///< of the strips
    std::vector<double>
        met_;  ///< parameters of the places, strip by strip; those between two belong to both
    std::vector<double> off_;  ///< parameters where patches are looked at, strip by strip
};

}  // namespace

std::unique_ptr<NearSide> profile_side(const Spine& spine, const Form& form, double depth,
                                       const std::vector<Station>& coarse, double part) {
    auto side = std::make_unique<ProfileSide>(spine, form, depth);
    if (!side->cut(coarse, part)) return nullptr;
    return side;
}

meshes::GivenNet ruled(const Cubic& from, const Cubic& to) {
    meshes::GivenNet net;
    for (std::size_t i = 0; i < 4; ++i) {
        net[4 * i] = from[i];
        net[4 * i + 1] = from[i] + (to[i] - from[i]) / 3.0;
        net[4 * i + 2] = from[i] + (to[i] - from[i]) * (2.0 / 3.0);
        net[4 * i + 3] = to[i];
    }
    return net;
}

Cubic parabola(Vec3 p, Vec3 middle, Vec3 q) {
    const Vec3 pull = middle * 2.0 - (p + q) * 0.5;
    return {p, (p + pull * 2.0) / 3.0, (q + pull * 2.0) / 3.0, q};
}

}  // namespace raymo::blends
