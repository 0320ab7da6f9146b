#include "tests/laws/model.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <unordered_map>

#include "raymo/meshes/smooth.hpp"
#include "tests/laws/contour.hpp"
#include "tests/laws/shell.hpp"

namespace raymo::laws {
namespace {

ModelPtr leaf(std::string name, std::vector<double> numbers, bool centred = false) {
    auto model = std::make_shared<Model>();
    model->primitive = std::move(name);
    model->numbers = std::move(numbers);
    model->centred = centred;
    return model;
}

ModelPtr swept(std::string name, curves::OutlinePtr outline, std::vector<double> numbers,
               bool centred = false) {
    auto model = std::make_shared<Model>();
    model->primitive = std::move(name);
    model->outline = std::move(outline);
    model->numbers = std::move(numbers);
    model->centred = centred;
    return model;
}

ModelPtr boolean(csg::Op op, ModelPtr a, ModelPtr b) {
    auto model = std::make_shared<Model>();
    model->op = op;
    model->children = {std::move(a), std::move(b)};
    return model;
}

std::vector<solids::Argument> arguments(const Model& m) {
    const std::vector<double>& n = m.numbers;
    if (m.primitive == "block") return {Vec3{n[0], n[1], n[2]}, m.centred};
    if (m.primitive == "sphere") return {n[0]};
    if (m.primitive == "cylinder") return {n[0], n[1], m.centred};
    if (m.primitive == "cone") return {n[0], n[1], n[2], m.centred};
    if (m.primitive == "torus") return {n[0], n[1]};
    if (m.primitive == "halfspace") return {Vec3{n[0], n[1], n[2]}, n[3]};
    if (m.primitive == "prism") return {m.outline, n[0], m.centred};
    if (m.primitive == "conic") return {m.outline, n[0], n[1], m.centred};
    if (m.primitive == "revolve") return {m.outline, n[0]};
    if (m.primitive == "sweep") {
        auto path = std::make_shared<curves::Path>();
        path->spans.resize(n.size() / 16);
        for (std::size_t i = 0; i < n.size(); i += 4) {
            curves::PathSpan& span = path->spans[i / 16];
            const std::size_t k = i / 4 % 4;
            span.x[k] = n[i];
            span.y[k] = n[i + 1];
            span.z[k] = n[i + 2];
            span.r[k] = n[i + 3];
        }
        return {curves::PathPtr(std::move(path)), std::size_t{0}};
    }
    if (m.primitive == "smooth") return {m.mesh};
    if (m.primitive == "patches") return {m.nets, std::size_t{0}};
    solids::Matrix4 matrix{};
    for (std::size_t i = 0; i < 16; ++i) matrix[i] = n[i];
    return {matrix};
}

csg::Solid build_leaf(const Model& m) {
    const auto rows = solids::inventory();
    for (std::uint32_t i = 0; i < rows.size(); ++i) {
        if (rows[i].schema->name != m.primitive) continue;
        auto solid = csg::primitive(i, arguments(m));
        if (solid) return *solid;
        std::fprintf(stderr, "laws: %s\n", solid.error().message.c_str());
    }
    std::abort();  // a mistake in the laws themselves
}

using Built = std::unordered_map<const Model*, csg::Solid>;

csg::Solid build(const Model& m, Built& built) {
    const auto found = built.find(&m);
    if (found != built.end()) return found->second;
    csg::Solid solid;
    if (!m.primitive.empty()) {
        solid = build_leaf(m);
    } else if (m.is_moved) {
        auto result = csg::transform(build(*m.children[0], built), m.map);
        if (!result) std::abort();
        solid = *result;
    } else {
        std::vector<csg::Solid> operands;
        for (const ModelPtr& child : m.children) operands.push_back(build(*child, built));
        solid = csg::boolean(m.op, std::move(operands));
    }
    built.emplace(&m, solid);
    return solid;
}

/// Distance from the nearest ball's surface, negative inside: the least over many samples, each refined.
Real sweep_distance(const std::vector<double>& n, const RealPoint& p) {
    constexpr int kSamples = 64;
    Real least = std::numeric_limits<Real>::infinity();
    for (std::size_t first = 0; first < n.size(); first += 16) {
        const auto distance = [&](Real u) {
            const Real v = 1 - u;
            const Real w[4] = {v * v * v, 3 * v * v * u, 3 * v * u * u, u * u * u};
            Real c[4] = {};
            for (std::size_t i = 0; i < 16; ++i)
                c[i % 4] += w[i / 4] * static_cast<Real>(n[first + i]);
            const Real x = c[0] - p.x, y = c[1] - p.y, z = c[2] - p.z;
            return std::sqrt(x * x + y * y + z * z) - c[3];
        };
        Real f[kSamples + 1];
        for (int i = 0; i <= kSamples; ++i) f[i] = distance(static_cast<Real>(i) / kSamples);
        for (int i = 0; i <= kSamples; ++i) {
            least = std::min(least, f[i]);
            if ((i > 0 && f[i] > f[i - 1]) || (i < kSamples && f[i] > f[i + 1])) continue;
            Real lo = std::max(static_cast<Real>(i - 1) / kSamples, Real(0));
            Real hi = std::min(static_cast<Real>(i + 1) / kSamples, Real(1));
            for (int k = 0; k < 40; ++k) {
                const Real a = lo + (hi - lo) * 0.38196601125010515L;
                const Real b = lo + (hi - lo) * 0.61803398874989485L;
                if (distance(a) < distance(b)) {
                    hi = b;
                } else {
                    lo = a;
                }
            }
            least = std::min(least, distance((lo + hi) / 2));
        }
    }
    return least;
}

/// A number that is negative inside and positive outside, and in size at most the distance from the boundary.
Real signed_distance(const Model& m, const RealPoint& p) {
    const auto n = [&](std::size_t i) { return static_cast<Real>(m.numbers[i]); };
    const auto slab = [&](Real x, Real size) {
        return std::fabs(m.centred ? x : x - size / 2) - size / 2;
    };
    const Real q = std::hypot(p.x, p.y);
    if (m.primitive == "block") {
        return std::max({slab(p.x, n(0)), slab(p.y, n(1)), slab(p.z, n(2))});
    }
    if (m.primitive == "sphere") return std::hypot(q, p.z) - n(0);
    if (m.primitive == "cylinder") return std::max(q - n(0), slab(p.z, n(1)));
    if (m.primitive == "cone") {
        const Real z = m.centred ? p.z + n(2) / 2 : p.z;
        const Real radius = n(0) + (n(1) - n(0)) * z / n(2);
        const Real side = (q - radius) * n(2) / std::hypot(n(2), n(1) - n(0));
        return std::max(side, slab(p.z, n(2)));
    }
    if (m.primitive == "torus") return std::hypot(q - n(0), p.z) - n(1);
    if (m.primitive == "sweep") return sweep_distance(m.numbers, p);
    return (n(0) * p.x + n(1) * p.y + n(2) * p.z - n(3)) / std::hypot(std::hypot(n(0), n(1)), n(2));
}

Side side_of(Real value, Real margin) {
    return value > margin ? Side::out : (value < -margin ? Side::in : Side::unclear);
}

Side classify_quadric(const Model& m, const RealPoint& p, Real margin) {
    const Real x[4] = {p.x, p.y, p.z, 1};
    Real f = 0, slope = 0, bend = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        Real row = 0;
        for (std::size_t j = 0; j < 4; ++j) {
            const Real entry = static_cast<Real>(m.numbers[4 * i + j]);
            row += entry * x[j];
            if (i < 3 && j < 3) bend += std::fabs(entry);
        }
        f += row * x[i];
        if (i < 3) slope += std::fabs(row);
    }
    return side_of(f, 2 * slope * margin + bend * margin * margin);
}

Side both(Side a, Side b) { return std::min(a, b); }

Side classify_swept(const Model& m, const RealPoint& p, Real margin) {
    const auto n = [&](std::size_t i) { return static_cast<Real>(m.numbers[i]); };
    if (m.primitive == "revolve") {
        const Side side = classify(*m.outline, std::hypot(p.x, p.y), p.z, margin, true);
        if (n(0) == 360 || side == Side::out) return side;
        const Real angle = n(0) * std::numbers::pi_v<Real> / 180;
        const Side start = side_of(-p.y, margin);
        const Side end = side_of(std::cos(angle) * p.y - std::sin(angle) * p.x, margin);
        return both(side, n(0) <= 180 ? both(start, end) : std::max(start, end));
    }
    const Real z = m.centred ? p.z + n(0) / 2 : p.z;
    const Side slab = side_of(std::fabs(z - n(0) / 2) - n(0) / 2, margin);
    if (slab == Side::out || m.primitive == "prism")
        return slab == Side::out ? slab : both(slab, classify(*m.outline, p.x, p.y, margin, false));
    // A conic sweep, seen at the scale of its lower end.
    const Real slope = (n(1) - 1) / n(0);
    const Real q = 1 + slope * z;
    const Real x = p.x / q, y = p.y / q;
    const Real wide = margin * (1 + std::fabs(slope) * std::hypot(x, y)) / q;
    if (!(q > 0) || !(wide < 1)) return Side::unclear;
    return both(slab, classify(*m.outline, x, y, wide, false));
}

RealMap inverse_of(const Affine& map) {
    Real a[3][3];
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            a[i][j] = static_cast<Real>(map.linear.row[static_cast<std::size_t>(i)][j]);
        }
    }
    RealMap out{};
    const auto cofactor = [&](int i, int j) {
        const int r0 = (i + 1) % 3, r1 = (i + 2) % 3, c0 = (j + 1) % 3, c1 = (j + 2) % 3;
        return a[r0][c0] * a[r1][c1] - a[r0][c1] * a[r1][c0];
    };
    const Real det = a[0][0] * cofactor(0, 0) + a[0][1] * cofactor(0, 1) + a[0][2] * cofactor(0, 2);
    Real sum = 0;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            out.m[i][j] = cofactor(j, i) / det;
            sum += out.m[i][j] * out.m[i][j];
        }
        out.shift[i] = static_cast<Real>(map.offset[i]);
    }
    out.norm = std::sqrt(sum);
    return out;
}

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", value);
    return text;
}

}  // namespace

ModelPtr block(Vec3 size, bool centred) { return leaf("block", {size.x, size.y, size.z}, centred); }
ModelPtr sphere(double r) { return leaf("sphere", {r}); }
ModelPtr cylinder(double r, double h, bool centred) { return leaf("cylinder", {r, h}, centred); }
ModelPtr cone(double r1, double r2, double h, bool centred) {
    return leaf("cone", {r1, r2, h}, centred);
}
ModelPtr torus(double ring, double tube) { return leaf("torus", {ring, tube}); }
ModelPtr halfspace(Vec3 normal, double offset) {
    return leaf("halfspace", {normal.x, normal.y, normal.z, offset});
}
ModelPtr quadric(const solids::Matrix4& m) {
    return leaf("quadric", std::vector<double>(m.begin(), m.end()));
}
ModelPtr prism(curves::OutlinePtr outline, double h, bool centred) {
    return swept("prism", std::move(outline), {h}, centred);
}
ModelPtr conic(curves::OutlinePtr outline, double h, double top) {
    return swept("conic", std::move(outline), {h, top});
}
ModelPtr revolve(curves::OutlinePtr outline, double angle) {
    return swept("revolve", std::move(outline), {angle});
}
ModelPtr sweep(std::vector<double> control) { return leaf("sweep", std::move(control)); }
ModelPtr smooth(meshes::Mesh mesh) {
    auto model = std::make_shared<Model>();
    model->primitive = "smooth";
    model->shell = std::make_shared<const meshes::Shell>(meshes::smooth(mesh).value());
    model->mesh = std::make_shared<const meshes::Mesh>(std::move(mesh));
    return model;
}
ModelPtr patches(std::vector<meshes::GivenNet> nets) {
    auto model = std::make_shared<Model>();
    model->primitive = "patches";
    model->shell = std::make_shared<const meshes::Shell>(meshes::sew(nets).value());
    model->nets = std::make_shared<const std::vector<meshes::GivenNet>>(std::move(nets));
    return model;
}
ModelPtr moved(ModelPtr child, const Affine& map) {
    auto model = std::make_shared<Model>();
    model->is_moved = true;
    model->map = map;
    model->back = inverse_of(map);
    model->children = {std::move(child)};
    return model;
}
ModelPtr moved(ModelPtr child, Vec3 by) { return moved(std::move(child), translation(by)); }
ModelPtr join(ModelPtr a, ModelPtr b) {
    return boolean(csg::Op::unite, std::move(a), std::move(b));
}
ModelPtr cut(ModelPtr a, ModelPtr b) {
    return boolean(csg::Op::difference, std::move(a), std::move(b));
}
ModelPtr meet(ModelPtr a, ModelPtr b) {
    return boolean(csg::Op::intersection, std::move(a), std::move(b));
}

csg::Solid build(const ModelPtr& model) {
    Built built;
    return build(*model, built);
}

Side classify(const Model& m, const RealPoint& p, Real margin) {
    if (m.primitive == "quadric") return classify_quadric(m, p, margin);
    if (m.outline != nullptr) return classify_swept(m, p, margin);
    if (m.shell != nullptr) return classify(*m.shell, p, margin);
    if (!m.primitive.empty()) return side_of(signed_distance(m, p), margin);
    if (m.is_moved) {
        const RealMap& back = m.back;
        const Real d[3] = {p.x - back.shift[0], p.y - back.shift[1], p.z - back.shift[2]};
        Real q[3];
        for (int i = 0; i < 3; ++i) {
            q[i] = back.m[i][0] * d[0] + back.m[i][1] * d[1] + back.m[i][2] * d[2];
        }
        return classify(*m.children[0], {q[0], q[1], q[2]}, margin * back.norm);
    }
    Side value = classify(*m.children[0], p, margin);
    for (std::size_t i = 1; i < m.children.size(); ++i) {
        Side other = classify(*m.children[i], p, margin);
        if (m.op == csg::Op::unite) {
            value = std::max(value, other);
        } else {
            if (m.op == csg::Op::difference) {
                other = other == Side::in ? Side::out : (other == Side::out ? Side::in : other);
            }
            value = std::min(value, other);
        }
    }
    return value;
}

std::string text(const Model& m) {
    if (!m.primitive.empty()) {
        std::string out = m.primitive + "(";
        for (std::size_t i = 0; i < m.numbers.size(); ++i)
            out += (i ? ", " : "") + number(m.numbers[i]);
        return out + (m.centred ? ", center: true)" : ")");
    }
    if (m.is_moved) {
        std::string out = text(*m.children[0]) + ".transform([";
        for (int i = 0; i < 3; ++i) {
            const Vec3 r = m.map.linear.row[static_cast<std::size_t>(i)];
            out += "[" + number(r.x) + ", " + number(r.y) + ", " + number(r.z) + ", " +
                   number(m.map.offset[i]) + "], ";
        }
        return out + "[0, 0, 0, 1]])";
    }
    const char* sign =
        m.op == csg::Op::unite ? " + " : (m.op == csg::Op::difference ? " - " : " & ");
    std::string out = "(";
    for (std::size_t i = 0; i < m.children.size(); ++i)
        out += (i ? sign : "") + text(*m.children[i]);
    return out + ")";
}

}  // namespace raymo::laws
