#include "raymo/blends/inner_corner.hpp"

#include <algorithm>
#include <cmath>

#include "raymo/math/affine.hpp"

namespace raymo::blends {
namespace {

/// Normals carry roundings that come with transformations, as in edge.cpp; a vertex is then off by so much of its distance.
constexpr double kRounded = 0x1p-40;

class Ring {
public:
    Ring(const std::vector<CornerPlane>& planes, double radius, double slack)
        : planes_(planes), radius_(radius), slack_(slack) {}

    [[nodiscard]] double level(std::size_t i) const { return planes_[i].level - radius_; }
    /// How far a point is beyond an inner plane.
    [[nodiscard]] double beyond(std::size_t i, Vec3 p) const {
        return dot(planes_[i].normal, p) - level(i);
    }
    [[nodiscard]] bool is_through(std::size_t i, Vec3 p) const {
        return std::fabs(beyond(i, p)) <= kRounded * norm(p) + slack_;
    }

    /// The point nearest to all of these inner planes, by least squares; improved twice by what it misses them by, so that the
    /// square of the condition does not count.
    [[nodiscard]] std::optional<Vec3> common(const std::vector<std::size_t>& members) const {
        Mat3 sum{{Vec3{}, Vec3{}, Vec3{}}};
        for (const std::size_t i : members) {
            const Vec3 n = planes_[i].normal;
            for (int row = 0; row < 3; ++row) {
                Vec3& to = sum.row[static_cast<std::size_t>(row)];
                to = to + n * n[row];
            }
        }
        if (!is_invertible(sum)) return std::nullopt;
        const Mat3 solve = inverse(sum);
        Vec3 p;
        for (int step = 0; step < 3; ++step) {
            Vec3 off;
            for (const std::size_t i : members) off = off - planes_[i].normal * beyond(i, p);
            p = p + solve * off;
        }
        return is_finite(p) ? std::optional(p) : std::nullopt;
    }

    /// Of the planes from first to last: those through p. The three that tell it always are.
    [[nodiscard]] std::vector<std::size_t> through(Vec3 p, std::size_t first, std::size_t touched,
                                                   std::size_t last) const {
        std::vector<std::size_t> members;
        for (std::size_t i = first; i <= last; ++i) {
            if (i == first || i == touched || i == last || is_through(i, p)) members.push_back(i);
        }
        return members;
    }

    /// The plane between first and last that is the first to be touched along their line, towards `along`.
    [[nodiscard]] std::optional<std::size_t> next(std::size_t first, std::size_t last,
                                                  Vec3 along) const {
        const Vec3 p = planes_[first].normal;
        const Vec3 q = planes_[last].normal;
        // A point of the line, in the plane of both normals: by their sum and difference, without cancellation.
        const Vec3 sum = p + q;
        const Vec3 difference = p - q;
        const Vec3 start =
            sum * ((level(first) + level(last)) / dot(sum, sum)) +
            difference * ((level(first) - level(last)) / dot(difference, difference));
        std::optional<std::size_t> nearest;
        double least = 0.0;
        for (std::size_t i = first + 1; i < last; ++i) {
            const double speed = dot(planes_[i].normal, along);
            if (!(speed > 0.0)) return std::nullopt;
            const double at = -beyond(i, start) / speed;
            if (!std::isfinite(at)) return std::nullopt;
            if (nearest && at >= least) continue;
            nearest = i;
            least = at;
        }
        return nearest;
    }

    /// The vertex on the line of first and last.
    [[nodiscard]] std::optional<InnerCorner::Vertex> vertex(std::size_t first, std::size_t last,
                                                            Vec3 along) const {
        const auto touched = next(first, last, along);
        if (!touched) return std::nullopt;
        // All at once, where one ball touches them: three neighbours out of many do not tell their point well.
        std::vector<std::size_t> members;
        for (std::size_t i = first; i <= last; ++i) members.push_back(i);
        std::optional<Vec3> at = common(members);
        if (at && std::all_of(members.begin(), members.end(),
                              [&](std::size_t i) { return is_through(i, *at); })) {
            return {{*at, members}};
        }
        // Else those through the point of three; and as these tell it better, once more.
        members = {first, *touched, last};
        for (int i = 0; i < 2; ++i) {
            at = common(members);
            if (!at) return std::nullopt;
            members = through(*at, first, *touched, last);
        }
        at = common(members);
        if (!at) return std::nullopt;
        return {{*at, std::move(members)}};
    }

private:
    const std::vector<CornerPlane>& planes_;
    double radius_;
    double slack_;
};

}  // namespace

std::optional<InnerCorner> inner_corner(const std::vector<CornerPlane>& planes, Vec3 edge,
                                        double radius, double slack) {
    const std::size_t count = planes.size();
    const Ring ring(planes, radius, slack);
    // Which way round.
    const Vec3 turn = cross(planes[0].normal, planes[1].normal);
    const double sense = dot(turn, edge) < 0.0 ? 1.0 : -1.0;

    InnerCorner out;
    out.first.resize(count);
    struct Open {
        std::size_t first, last;
        std::optional<std::size_t> from;  ///< the vertex at the other end of the bridge
    };
    std::vector<Open> open{{0, count - 1, std::nullopt}};
    while (!open.empty()) {
        const Open now = open.back();
        open.pop_back();
        const Vec3 along = cross(planes[now.last].normal, planes[now.first].normal) * sense;
        auto vertex = ring.vertex(now.first, now.last, along);
        if (!vertex) return std::nullopt;
        const std::size_t index = out.vertices.size();
        if (now.from) {
            out.bridges.push_back({{now.first, now.last}, {*now.from, index}});
        } else {
            out.first[count - 1] = index;
        }
        for (std::size_t i = 1; i < vertex->planes.size(); ++i) {
            const std::size_t p = vertex->planes[i - 1];
            const std::size_t q = vertex->planes[i];
            if (q == p + 1) {
                out.first[p] = index;
            } else {
                open.push_back({p, q, index});
            }
        }
        out.vertices.push_back(*std::move(vertex));
    }
    return out;
}

}  // namespace raymo::blends
