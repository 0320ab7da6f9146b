#include "scaling/models.hpp"

#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "primitive.hpp"

namespace raymo::bench {
namespace {

using csg::Solid;

/// Collects solids and the first error among them, so that the models below read like what they
/// describe.
class Builder {
public:
    Solid take(Result<Solid> solid) {
        if (solid) return *std::move(solid);
        if (!error_) error_ = std::move(solid).error();
        return {};
    }
    Solid block(Vec3 size) { return take(primitive("block", {{"size", size}, {"center", true}})); }
    Solid sphere(double r) { return take(primitive("sphere", {{"r", r}})); }
    Solid cylinder(double r, double h) {
        return take(primitive("cylinder", {{"r", r}, {"h", h}, {"center", true}}));
    }
    Solid placed(const Solid& solid, const Affine& map) {
        return solid ? take(csg::transform(solid, map)) : Solid{};
    }
    Solid moved(const Solid& solid, Vec3 by) { return placed(solid, translation(by)); }
    Solid boolean(csg::Op op, std::vector<Solid> operands) {
        return error_ ? Solid{} : csg::boolean(op, std::move(operands));
    }
    Result<Solid> finished(Solid solid) {
        if (error_) return fail(*std::move(error_));
        return solid;
    }

private:
    std::optional<Error> error_;
};

/// A direction, all equally likely.
Vec3 random_direction(std::mt19937_64& random) {
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    for (;;) {
        const Vec3 v{number(random), number(random), number(random)};
        const double length = dot(v, v);
        if (length > 1e-4 && length <= 1.0) return unit(v);
    }
}

/// A turn that takes the z axis to the unit vector `to`.
Affine turned_to(Vec3 to) {
    Vec3 s;
    Vec3 t;
    make_frame(to, s, t);
    return {{{Vec3{s.x, t.x, to.x}, Vec3{s.y, t.y, to.y}, Vec3{s.z, t.z, to.z}}}, {}};
}

/// A plate of 100 x 100 x 1 with holes in rows and columns, cut by one union of cylinders.
Result<Solid> plate(std::size_t holes) {
    Builder b;
    std::size_t columns =
        static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(holes))));
    while (holes % columns != 0) ++columns;
    const std::size_t rows = holes / columns;
    const double dx = 100.0 / static_cast<double>(columns);
    const double dy = 100.0 / static_cast<double>(rows);
    const Solid hole = b.cylinder(0.35 * std::min(dx, dy), 2.0);
    std::vector<Solid> drilled;
    for (std::size_t i = 0; i < columns; ++i) {
        for (std::size_t j = 0; j < rows; ++j) {
            drilled.push_back(b.moved(hole, {(static_cast<double>(i) + 0.5) * dx - 50.0,
                                             (static_cast<double>(j) + 0.5) * dy - 50.0, 0.0}));
        }
    }
    const Solid sheet = b.block({100, 100, 1});
    return b.finished(
        b.boolean(csg::Op::difference, {sheet, b.boolean(csg::Op::unite, std::move(drilled))}));
}

/// ((((plate + stud) - dent) + stud) - dent) ...: a chain as deep as there are leaves, each of which matters only where
/// it is. Neighbours in the chain are far apart on the plate.
Result<Solid> chain(std::size_t leaves) {
    Builder b;
    const std::size_t columns =
        static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(leaves))));
    std::vector<std::size_t> cells(columns * columns);
    std::iota(cells.begin(), cells.end(), std::size_t{0});
    std::mt19937_64 random(3);
    for (std::size_t i = cells.size(); i-- > 1;) std::swap(cells[i], cells[random() % (i + 1)]);
    const double pitch = 100.0 / static_cast<double>(columns);
    const Solid ball = b.sphere(0.45 * pitch);
    Solid tree = b.block({100, 100, 10});
    for (std::size_t i = 0; i + 1 < leaves; ++i) {
        const double x = (static_cast<double>(cells[i] % columns) + 0.5) * pitch - 50.0;
        const double y = (static_cast<double>(cells[i] / columns) + 0.5) * pitch - 50.0;
        const csg::Op op = i % 2 == 0 ? csg::Op::unite : csg::Op::difference;
        tree = b.boolean(op, {std::move(tree), b.moved(ball, {x, y, 5.0})});
    }
    return b.finished(tree);
}

/// plate - (disc - (disc - (disc - ...))): rings, each disc standing in all the ones before it, so that a point in the
/// middle is decided by every leaf.
Result<Solid> rings(std::size_t leaves) {
    Builder b;
    const double width = 50.0 / static_cast<double>(leaves);
    Solid tail;
    for (std::size_t i = leaves; i-- > 0;) {
        Solid here = i == 0 ? b.block({100, 100, 10})
                            : b.cylinder(50.0 - width * static_cast<double>(i), 20.0);
        tail = tail ? b.boolean(csg::Op::difference, {std::move(here), std::move(tail)})
                    : std::move(here);
    }
    return b.finished(tail);
}

/// A cube of 80 minus rods that all pass through its middle: every box of the tree overlaps every
/// other one.
Result<Solid> hedgehog(std::size_t leaves) {
    Builder b;
    std::mt19937_64 random(7);
    const Solid rod = b.cylinder(25.0 / std::sqrt(static_cast<double>(leaves)), 200.0);
    std::vector<Solid> rods;
    for (std::size_t i = 0; i < leaves; ++i)
        rods.push_back(b.placed(rod, turned_to(random_direction(random))));
    const Solid cube = b.block({80, 80, 80});
    return b.finished(
        b.boolean(csg::Op::difference, {cube, b.boolean(csg::Op::unite, std::move(rods))}));
}

/// A haystack: the union of long thin rods, mostly at an angle to the axes, where boxes fit worst.
Result<Solid> needles(std::size_t leaves) {
    Builder b;
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> place(-30.0, 30.0);
    const Solid rod = b.cylinder(5.0 / std::sqrt(static_cast<double>(leaves)), 60.0);
    std::vector<Solid> rods;
    for (std::size_t i = 0; i < leaves; ++i) {
        const Affine turn = turned_to(random_direction(random));
        rods.push_back(
            b.placed(rod, translation({place(random), place(random), place(random)}) * turn));
    }
    return b.finished(b.boolean(csg::Op::unite, std::move(rods)));
}

scene::Camera camera(Vec3 eye, double angle) {
    scene::Camera view;
    view.eye = eye;
    view.look_at = {};
    view.angle = angle;
    return view;
}

}  // namespace

std::span<const Family> families() {
    static constexpr std::array<std::size_t, 6> kToMillion{10,     100,     1'000,
                                                           10'000, 100'000, 1'000'000};
    static constexpr std::array<std::size_t, 4> kToTenThousand{10, 100, 1'000, 10'000};
    static constexpr std::array<std::size_t, 3> kToThousand{10, 100, 1'000};
    static const std::array<Family, 5> kFamilies{
        Family{"plate", "plate with n holes", plate, camera({30, -70, 110}, 40), kToMillion},
        Family{"chain", "(((plate + stud) - dent) + stud) - ..., n deep", chain,
               camera({30, -70, 110}, 40), kToTenThousand, 4},
        Family{"rings", "plate - (disc - (disc - ...)), n deep, one inside the other", rings,
               camera({30, -70, 110}, 40), kToThousand, 4},
        Family{"hedgehog", "cube minus n rods through one point", hedgehog,
               camera({90, -130, 100}, 40), kToThousand},
        Family{"needles", "union of n long thin rods", needles, camera({90, -130, 100}, 30),
               kToTenThousand, 4},
    };
    return kFamilies;
}

}  // namespace raymo::bench
