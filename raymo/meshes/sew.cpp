#include "raymo/meshes/sew.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>

#include "raymo/meshes/mesh.hpp"

namespace raymo::meshes {
namespace {

Failure refuse(ErrorCode code, std::string message, std::string hint, std::string label = {}) {
    Failure failure = fail(code, std::move(message), std::move(hint));
    failure.value().argument = 0;
    failure.value().label = std::move(label);
    return failure;
}

/// Finds points that are the same but for rounding: in a grid of cells, each a few times as large as the tolerance.
class Points {
public:
    Points(Vec3 origin, double tolerance)
        : origin_(origin), tolerance_(tolerance), cell_(8.0 * tolerance) {}

    Index find(Vec3 p, std::vector<Vec3>& points) {
        const auto at = [&](double x) { return static_cast<std::int64_t>(std::floor(x / cell_)); };
        const Vec3 q = p - origin_;
        const Vec3 r{tolerance_, tolerance_, tolerance_};
        const Vec3 lo = q - r, hi = q + r;
        for (std::int64_t x = at(lo.x); x <= at(hi.x); ++x) {
            for (std::int64_t y = at(lo.y); y <= at(hi.y); ++y) {
                for (std::int64_t z = at(lo.z); z <= at(hi.z); ++z) {
                    const auto found = cells_.find({x, y, z});
                    if (found == cells_.end()) continue;
                    for (const Index k : found->second) {
                        if (max_norm(points[k] - p) <= tolerance_) return k;
                    }
                }
            }
        }
        const auto k = static_cast<Index>(points.size());
        points.push_back(p);
        cells_[{at(q.x), at(q.y), at(q.z)}].push_back(k);
        return k;
    }

private:
    Vec3 origin_;
    double tolerance_, cell_;
    std::map<std::tuple<std::int64_t, std::int64_t, std::int64_t>, std::vector<Index>> cells_;
};

/// The control points of the four borders, round the patch.
constexpr std::array<std::array<std::size_t, 4>, 4> kBorders{
    {{0, 4, 8, 12}, {12, 13, 14, 15}, {15, 11, 7, 3}, {3, 2, 1, 0}}};

struct Border {
    std::array<Index, 4> key;
    std::size_t patch;
    std::size_t side;
    bool reversed;
};

Net transposed(const Net& net) {
    Net out{};
    for (std::size_t k = 0; k < 16; ++k) out[k] = net[4 * (k % 4) + k / 4];
    return out;
}

}  // namespace

GivenNet bezier_of_bspline(const GivenNet& net) {
    const auto convert = [](Vec3 a, Vec3 b, Vec3 c, Vec3 d, std::array<Vec3, 4>& out) {
        out = {(a + b * 4.0 + c) / 6.0, (b * 2.0 + c) / 3.0, (b + c * 2.0) / 3.0,
               (b + c * 4.0 + d) / 6.0};
    };
    GivenNet half, out;
    std::array<Vec3, 4> row;
    for (std::size_t i = 0; i < 4; ++i) {
        convert(net[4 * i], net[4 * i + 1], net[4 * i + 2], net[4 * i + 3], row);
        for (std::size_t j = 0; j < 4; ++j) half[4 * i + j] = row[j];
    }
    for (std::size_t j = 0; j < 4; ++j) {
        convert(half[j], half[4 + j], half[8 + j], half[12 + j], row);
        for (std::size_t i = 0; i < 4; ++i) out[4 * i + j] = row[i];
    }
    return out;
}

Result<Shell> sew(const std::vector<GivenNet>& nets) {
    if (nets.empty()) {
        return refuse(ErrorCode::bad_argument, "there are no patches",
                      "give a list of nets, each of four rows of four points");
    }
    Aabb box;
    for (std::size_t n = 0; n < nets.size(); ++n) {
        for (const Vec3 p : nets[n]) {
            if (!is_finite(p) || !(max_norm(p) <= kLargestPoint)) {
                return refuse(ErrorCode::out_of_range,
                              "a point is too far away to be computed with",
                              "stay within 1e90 of the origin",
                              "[" + std::to_string(n) + "] has " + shown_point(p));
            }
            box.include(p);
        }
    }
    Shell out;
    Points points(box.lo, 0x1p-40 * max_norm(box.size()));
    if (!(max_norm(box.size()) > 0.0)) {
        return refuse(ErrorCode::bad_argument, "the patches bound no volume",
                      "give points that differ");
    }
    for (const GivenNet& given : nets) {
        Net net{};
        for (std::size_t k = 0; k < 16; ++k) {
            const bool is_inside = k == 5 || k == 6 || k == 9 || k == 10;
            if (is_inside) {
                net[k] = static_cast<Index>(out.points.size());
                out.points.push_back(given[k]);
            } else {
                net[k] = points.find(given[k], out.points);
            }
        }
        out.patches.push_back(net);
    }

    // Borders that belong together stand beside each other when sorted.
    std::vector<Border> borders;
    for (std::size_t n = 0; n < out.patches.size(); ++n) {
        for (std::size_t side = 0; side < 4; ++side) {
            std::array<Index, 4> key{};
            for (std::size_t k = 0; k < 4; ++k) key[k] = out.patches[n][kBorders[side][k]];
            if (key[0] == key[1] && key[1] == key[2] && key[2] == key[3]) continue;
            std::array<Index, 4> reversed{key[3], key[2], key[1], key[0]};
            const bool turn = reversed < key;
            borders.push_back({turn ? reversed : key, n, side, turn});
        }
    }
    std::sort(borders.begin(), borders.end(), [](const Border& a, const Border& b) {
        return std::tie(a.key, a.patch, a.side) < std::tie(b.key, b.patch, b.side);
    });
    struct Link {
        std::size_t patch;
        bool opposed;  ///< both run along the border in opposite directions
    };
    std::vector<std::vector<Link>> links(out.patches.size());
    for (std::size_t i = 0; i < borders.size();) {
        std::size_t end = i + 1;
        while (end < borders.size() && borders[end].key == borders[i].key) ++end;
        const auto place = [&] {
            return "from " + shown_point(out.points[borders[i].key[0]]) + " to " +
                   shown_point(out.points[borders[i].key[3]]);
        };
        if (end - i != 2) {
            return refuse(ErrorCode::bad_argument,
                          end - i == 1 ? "the patches do not close up: the border " + place() +
                                             " belongs to one of them only"
                                       : "the border " + place() + " belongs to " +
                                             std::to_string(end - i) + " patches",
                          "each border must be that of two patches, with the same four points",
                          "it is a border of [" + std::to_string(borders[i].patch) + "]");
        }
        const bool opposed = borders[i].reversed != borders[i + 1].reversed;
        links[borders[i].patch].push_back({borders[i + 1].patch, opposed});
        links[borders[i + 1].patch].push_back({borders[i].patch, opposed});
        i = end;
    }
    // Each piece of the surface is turned as its first patch is.
    enum class State : std::uint8_t { open, kept, turned };
    std::vector<State> state(out.patches.size(), State::open);
    std::vector<std::size_t> todo;
    for (std::size_t first = 0; first < state.size(); ++first) {
        if (state[first] != State::open) continue;
        state[first] = State::kept;
        todo.push_back(first);
        while (!todo.empty()) {
            const std::size_t at = todo.back();
            todo.pop_back();
            for (const Link& link : links[at]) {
                const State wanted =
                    link.opposed == (state[at] == State::kept) ? State::kept : State::turned;
                if (state[link.patch] == State::open) {
                    state[link.patch] = wanted;
                    todo.push_back(link.patch);
                } else if (state[link.patch] != wanted) {
                    return refuse(ErrorCode::bad_argument,
                                  "the patches make a surface that has one side only",
                                  "such a surface bounds no solid",
                                  "[" + std::to_string(link.patch) + "] can not be turned right");
                }
            }
        }
    }
    for (std::size_t n = 0; n < state.size(); ++n) {
        if (state[n] == State::turned) out.patches[n] = transposed(out.patches[n]);
    }
    const double volume = volume_of(out);
    const double size = max_norm(box.size());
    if (!(std::fabs(volume) > 1e-12 * size * size * size)) {
        return refuse(ErrorCode::bad_argument, "the patches bound no volume",
                      "give the surface some thickness");
    }
    if (volume < 0.0) {
        for (Net& net : out.patches) net = transposed(net);
    }
    return out;
}

}  // namespace raymo::meshes
