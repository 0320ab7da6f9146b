// Meshes: points, and faces of any number of sides, to be smoothed.

#include <fmt/core.h>

#include <array>

#include "raymo/meshes/build.hpp"
#include "raymo/meshes/obj.hpp"
#include "raymo/sml/builtins/call.hpp"
#include "raymo/sml/drawings.hpp"
#include "raymo/sml/text.hpp"

namespace raymo::sml {
namespace {

constexpr double kMostCuts = 1000;

bool finish(Call& call, Result<meshes::Mesh> made, std::initializer_list<std::size_t> slots,
            Value& out) {
    if (!made) return call.fail(std::move(made).error(), std::span(slots.begin(), slots.size()));
    return call.evaluator().made(std::move(*made), call.node(), out);
}

/// A list of points of three numbers; `where` is what errors call it.
bool points_of(Call& call, std::size_t i, const Value& value, const std::string& where,
               std::vector<Vec3>& out) {
    if (!value.is(Tag::list)) {
        return call.fail(
            i, ErrorCode::bad_argument, fmt::format("{} must be a list of points", where),
            "write them as [(0, 0, 0), (10, 0, 5)]", fmt::format("this is {}", kind_text(value)));
    }
    const auto& items = value.items();
    if (!call.evaluator().room(sizeof(Vec3) * static_cast<double>(items.size()), call.node()))
        return false;
    out.resize(items.size());
    for (std::size_t k = 0; k < items.size(); ++k) {
        if (is_vector(items[k], out[k])) continue;
        return call.fail(i, ErrorCode::bad_argument,
                         fmt::format("{} must be a list of points of three numbers", where),
                         "a point is written (x, y, z)",
                         fmt::format("[{}] is {}", k, numbers_text(items[k])));
    }
    return call.evaluator().worked(static_cast<double>(items.size()), call.node());
}

// mesh(points, faces)
bool mesh(Call& call, Value& out) {
    std::vector<Vec3> points;
    if (!call.has(0)) return call.wrong_kind(0, "a list of points");
    if (!points_of(call, 0, call[0], "`points`", points)) return false;
    if (!call.has(1) || !call[1].is(Tag::list)) {
        return call.wrong_kind(1, "a list of faces",
                               "each is a list of numbers of points: [[0, 1, 2], [0, 2, 3]]");
    }
    const auto& items = call[1].items();
    std::vector<std::vector<double>> faces(items.size());
    double corners = 0.0;
    for (std::size_t f = 0; f < items.size(); ++f) {
        bool good = items[f].is(Tag::list);
        if (good) {
            corners += static_cast<double>(items[f].items().size());
            if (!call.evaluator().room(24.0 * corners, call.node())) return false;
            for (const Value& n : items[f].items()) {
                good = good && n.is(Tag::number);
                if (good) faces[f].push_back(n.number());
            }
        }
        if (good) continue;
        return call.fail(1, ErrorCode::bad_argument,
                         "`faces` must be a list of lists of numbers of points",
                         "a face is written [0, 1, 2, 3]",
                         fmt::format("[{}] is {}", f, kind_and_size(items[f])));
    }
    return call.evaluator().worked(corners, call.node()) &&
           finish(call, meshes::make_mesh(std::move(points), faces), {0, 1}, out);
}

// box_mesh(dx, dy, dz), box_mesh((dx, dy, dz)), box_mesh(s)
bool box_mesh(Call& call, Value& out) {
    Vec3 size;
    if (call.has(0) && call[0].is(Tag::list)) {
        if (call.has(1) || call.has(2)) {
            return call.fail(call.has(1) ? 1 : 2, ErrorCode::bad_argument,
                             "the size is given already",
                             "give one vector, three numbers, or one number for a cube");
        }
        if (!call.vector(0, size)) return false;
    } else {
        if (!call.number(0, size.x)) return false;
        size = {size.x, size.x, size.x};
        if (call.has(1) != call.has(2)) {
            return call.fail(ErrorCode::bad_argument,
                             call.has(1) ? "the third number of the size is missing"
                                         : "the second number of the size is missing",
                             "give three numbers, or one for a cube");
        }
        if (call.has(1) && (!call.number(1, size.y) || !call.number(2, size.z))) return false;
    }
    for (int a = 0; a < 3; ++a) {
        if (size[a] > 0.0 && size[a] <= meshes::kLargestPoint) continue;
        const std::size_t at =
            call.has(static_cast<std::size_t>(a)) ? static_cast<std::size_t>(a) : 0;
        return call.fail(at, ErrorCode::out_of_range,
                         size[a] > 0.0 ? "the size is too large to be computed with"
                                       : "size must be greater than 0",
                         size[a] > 0.0 ? "stay below 1e90" : "give positive sizes",
                         fmt::format("this is {}", number_text(size[a])));
    }
    Vec3 cuts{1, 1, 1};
    if (call.has(3)) {
        if (call[3].is(Tag::number)) {
            cuts.x = cuts.y = cuts.z = call[3].number();
        } else if (!call.vector(3, cuts)) {
            return false;
        }
        for (int a = 0; a < 3; ++a) {
            if (cuts[a] >= 1.0 && cuts[a] <= kMostCuts && cuts[a] == std::floor(cuts[a])) continue;
            return call.fail(
                3, ErrorCode::out_of_range,
                fmt::format("`cuts` must be whole numbers from 1 to {}", number_text(kMostCuts)),
                "a side that is cut into n has n faces in a row",
                fmt::format("this is {}", number_text(cuts[a])));
        }
    }
    bool is_centred = false;
    if (call.has(4) && !call.flag(4, is_centred)) return false;
    const double faces = 2.0 * (cuts.x * cuts.y + cuts.y * cuts.z + cuts.z * cuts.x);
    if (!call.evaluator().room(160.0 * faces, call.node()) ||
        !call.evaluator().worked(20.0 * faces, call.node()))
        return false;
    meshes::Mesh made = meshes::box_mesh(
        size, {static_cast<meshes::Index>(cuts.x), static_cast<meshes::Index>(cuts.y),
               static_cast<meshes::Index>(cuts.z)});
    if (is_centred) made = meshes::mapped(made, translation(size * -0.5));
    return call.evaluator().made(std::move(made), call.node(), out);
}

// extrude_mesh(points, h)
bool extrude_mesh(Call& call, Value& out) {
    std::vector<Vec2> points;
    double h = 0.0;
    double cuts = 1.0;
    bool is_centred = false;
    if (!call.points(0, points) || !call.positive(1, h)) return false;
    if (call.has(2) && !call.whole(2, 1, kMostCuts, cuts)) return false;
    if (call.has(3) && !call.flag(3, is_centred)) return false;
    for (std::size_t k = 0; k < points.size(); ++k) {
        if (max_norm(points[k]) <= meshes::kLargestPoint && h <= meshes::kLargestPoint) continue;
        return call.fail(h <= meshes::kLargestPoint ? 0 : 1, ErrorCode::out_of_range,
                         "it is too large to be computed with", "stay within 1e90 of the origin");
    }
    const double sides = static_cast<double>(points.size()) * (cuts + 1.0);
    if (!call.evaluator().room(100.0 * sides, call.node()) ||
        !call.evaluator().worked(sides, call.node()))
        return false;
    auto made = meshes::extrude_mesh(std::move(points), h, static_cast<meshes::Index>(cuts));
    if (made && is_centred) made = meshes::mapped(*made, translation({0, 0, -0.5 * h}));
    return finish(call, std::move(made), {0}, out);
}

// grid_mesh(rows, closed: "rows")
bool grid_mesh(Call& call, Value& out) {
    static constexpr auto kWords = std::to_array<std::string_view>({"none", "rows", "both"});
    static constexpr std::array kClosings{meshes::Closing::none, meshes::Closing::rows,
                                          meshes::Closing::both};
    std::size_t closing = 1;
    if (call.has(1) && !call.choice(1, kWords, closing)) return false;
    if (!call.has(0) || !call[0].is(Tag::list)) {
        return call.wrong_kind(0, "a list of rows",
                               "each row is a list of points: [[(0, 0, 0), (1, 0, 0)], ...]");
    }
    const auto& items = call[0].items();
    std::vector<std::vector<Vec3>> rows(items.size());
    double count = 0.0;
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (!points_of(call, 0, items[i], fmt::format("row [{}]", i), rows[i])) return false;
        count += static_cast<double>(rows[i].size());
        for (const Vec3 p : rows[i]) {
            if (max_norm(p) <= meshes::kLargestPoint) continue;
            return call.fail(0, ErrorCode::out_of_range,
                             "a point is too far away to be computed with",
                             "stay within 1e90 of the origin");
        }
        if (!call.evaluator().room(100.0 * count, call.node())) return false;
    }
    if (count > static_cast<double>(meshes::kMostCorners) / 4.0) {
        return call.fail(0, ErrorCode::limit, "the mesh is too large", "use a coarser mesh");
    }
    return finish(call, meshes::grid_mesh(rows, kClosings[closing]), {0}, out);
}

// import_mesh("cage.obj")
bool import_mesh(Call& call, Value& out) {
    std::string file;
    if (!call.text(0, file)) return false;
    const auto fail_at = [&](Error error) {
        error.message = call.name() + ": " + error.message;
        if (error.label.empty())
            error.label = fmt::format("this is {}", quoted(drawings::shortened(file, 40)));
        error.where = call.where(0);
        return call.fail(std::move(error));
    };
    auto text = call.evaluator().drawings().text(call.evaluator().path(call.span()), file);
    if (!text) return fail_at(std::move(text).error());
    bool is_reported = false;
    const double file_bytes = static_cast<double>(text->size());
    auto made = meshes::read_obj(*text, [&](double bytes) {
        is_reported = !call.evaluator().room(file_bytes + bytes, call.node()) ||
                      !call.evaluator().worked(1e5, call.node());
        return !is_reported;
    });
    if (is_reported) return false;
    if (!made) return fail_at(std::move(made).error());
    return call.evaluator().made(std::move(*made), call.node(), out);
}

// crease(mesh, [(0, 1), (1, 2)]), crease(mesh, angle: 60)
bool crease(Call& call, Value& out) {
    meshes::MeshPtr given;
    if (!call.mesh(0, given)) return false;
    if (!call.has(1) && !call.has(2)) {
        return call.fail(ErrorCode::bad_argument, "it is not said which edges",
                         "list pairs of numbers of points, or give an angle: crease(angle: 60)");
    }
    if (!call.evaluator().room(3.0 * meshes::bytes_of(*given), call.node())) return false;
    meshes::Mesh mesh = *given;
    if (call.has(2)) {
        double angle = 0.0;
        if (!call.number(2, angle)) return false;
        if (!(angle >= 0.0 && angle <= 180.0)) {
            return call.fail(2, ErrorCode::out_of_range, "`angle` must be from 0 to 180",
                             "edges at which faces bend by more become sharp",
                             fmt::format("this is {}", number_text(angle)));
        }
        if (!call.evaluator().worked(10.0 * static_cast<double>(mesh.corners.size()), call.node()))
            return false;
        mesh = meshes::creased_by_angle(std::move(mesh), angle);
    }
    if (!call.has(1)) return call.evaluator().made(std::move(mesh), call.node(), out);
    if (!call[1].is(Tag::list)) {
        return call.wrong_kind(1, "a list of edges", "write pairs of numbers of points: [(0, 1)]");
    }
    std::vector<meshes::Edge> edges;
    const auto& items = call[1].items();
    for (std::size_t k = 0; k < items.size(); ++k) {
        Vec2 pair;
        const auto is_number = [&](double n) {
            return n >= 0.0 && n < static_cast<double>(mesh.points.size()) && n == std::floor(n);
        };
        if (is_vector2(items[k], pair) && is_number(pair.x) && is_number(pair.y)) {
            edges.push_back(
                {static_cast<meshes::Index>(pair.x), static_cast<meshes::Index>(pair.y)});
            continue;
        }
        return call.fail(
            1, ErrorCode::bad_argument, "an edge is a pair of numbers of points",
            fmt::format("the points have the numbers 0 to {}", mesh.points.size() - 1),
            is_vector2(items[k], pair)
                ? fmt::format("[{}] is ({}, {})", k, number_text(pair.x), number_text(pair.y))
                : fmt::format("[{}] is {}", k, numbers_text(items[k])));
    }
    return finish(call, meshes::creased(std::move(mesh), edges), {0, 1}, out);
}

// warp(mesh, f): every point p where f(p) is
bool warp(Call& call, Value& out) {
    meshes::MeshPtr given;
    if (!call.mesh(0, given) || !call.function(1)) return false;
    if (!call.evaluator().room(meshes::bytes_of(*given), call.node())) return false;
    meshes::Mesh mesh = *given;
    for (Vec3& p : mesh.points) {
        const Value point = Value::vector(p);
        Value moved;
        if (!call.evaluator().call(call[1], std::span(&point, 1), call.node(), moved)) return false;
        Vec3 to;
        if (!is_vector(moved, to)) {
            return call.fail(1, ErrorCode::bad_argument, "the function must give a point",
                             "write fn(p) (p.x, p.y, 2 * p.z)",
                             fmt::format("it gave {}", numbers_text(moved)));
        }
        if (!(max_norm(to) <= meshes::kLargestPoint)) {
            return call.fail(1, ErrorCode::out_of_range,
                             "the mesh becomes too large to be computed with",
                             "stay within 1e90 of the origin");
        }
        p = to;
    }
    return call.evaluator().made(std::move(mesh), call.node(), out);
}

}  // namespace

bool take_nets(Call& call, std::size_t slot, meshes::NetsPtr& out) {
    if (!call.has(slot) || !call[slot].is(Tag::list)) {
        return call.wrong_kind(slot, "a list of nets",
                               "each net is four rows of four points: [[[(0, 0, 0), ...], ...]]");
    }
    const auto& items = call[slot].items();
    if (!call.evaluator().room(sizeof(meshes::GivenNet) * 4.0 * static_cast<double>(items.size()),
                               call.node()))
        return false;
    std::vector<meshes::GivenNet> nets(items.size());
    for (std::size_t n = 0; n < items.size(); ++n) {
        const auto refuse = [&](const std::string& label) {
            return call.fail(slot, ErrorCode::bad_argument,
                             "a net is four rows of four points of three numbers",
                             "write [[(0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0, 0)], ...]", label);
        };
        const std::string name = fmt::format("[{}]", n);
        if (!items[n].is(Tag::list) || items[n].items().size() != 4)
            return refuse(fmt::format("{} is {}", name, kind_and_size(items[n])));
        for (std::size_t i = 0; i < 4; ++i) {
            const Value& row = items[n].items()[i];
            if (!row.is(Tag::list) || row.items().size() != 4)
                return refuse(fmt::format("{}[{}] is {}", name, i, kind_and_size(row)));
            for (std::size_t j = 0; j < 4; ++j) {
                if (is_vector(row.items()[j], nets[n][4 * i + j])) continue;
                return refuse(
                    fmt::format("{}[{}][{}] is {}", name, i, j, numbers_text(row.items()[j])));
            }
        }
        if (!call.evaluator().step(call.node())) return false;
    }
    out = std::make_shared<const std::vector<meshes::GivenNet>>(std::move(nets));
    return true;
}

std::span<const BuiltinRow> mesh_rows() {
    static constexpr auto kRows = std::to_array<BuiltinRow>({
        {"mesh", "points faces", &mesh,
         "Faces of any number of sides, each a list of numbers of points."},
        {"box_mesh", "dx dy? dz? | cuts? center?", &box_mesh,
         "A box of faces; `cuts` says how many there are in a row along x, y and z."},
        {"extrude_mesh", "points h | cuts? center?", &extrude_mesh,
         "A polygon moved up by h, with its sides cut into `cuts` rings."},
        {"grid_mesh", "rows | closed?", &grid_mesh,
         "Faces between rows of points; the rows are rings unless `closed` says otherwise."},
        {"import_mesh", "file", &import_mesh, "The points and faces of an OBJ file."},
        {"crease", "mesh edges? | angle?", &crease,
         "The mesh with these edges sharp, or those that bend by more than an angle."},
        {"warp", "mesh f", &warp, "The mesh with every point p where f(p) is."},
    });
    return kRows;
}

}  // namespace raymo::sml
