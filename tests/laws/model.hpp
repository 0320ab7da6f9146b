// Models as the laws make them, with a judge of their own: where a point is, from the numbers the model was written with,
// in extended precision and by other formulas than the library's.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "raymo/csg/model.hpp"
#include "raymo/curves/outline.hpp"

namespace raymo::laws {

using Real = long double;

/// `unclear`: nearer to the boundary of some leaf that matters than the margin.
enum class Side { out, unclear, in };

struct RealPoint {
    Real x, y, z;
};

struct Model;
using ModelPtr = std::shared_ptr<const Model>;

/// The inverse of a map, and the Frobenius norm of its linear part.
struct RealMap {
    Real m[3][3];
    Real shift[3];
    Real norm;
};

/// An expression: a primitive with its arguments, a moved solid, or a Boolean.
struct Model {
    std::string primitive;  ///< empty for the others
    std::vector<double> numbers;
    curves::OutlinePtr outline;  ///< of a sweep
    meshes::MeshPtr mesh;        ///< of a smoothed one
    meshes::NetsPtr nets;        ///< of patches
    meshes::ShellPtr shell;      ///< of both: the surface that is judged
    bool centred = false;
    Affine map;  ///< with one child and no primitive: the child is moved
    bool is_moved = false;
    RealMap back = {};  ///< inverse of `map`
    csg::Op op = csg::Op::unite;
    std::vector<ModelPtr> children;
};

[[nodiscard]] ModelPtr block(Vec3 size, bool centred = false);
[[nodiscard]] ModelPtr sphere(double r);
[[nodiscard]] ModelPtr cylinder(double r, double h, bool centred = false);
[[nodiscard]] ModelPtr cone(double r1, double r2, double h, bool centred = false);
[[nodiscard]] ModelPtr torus(double ring, double tube);
[[nodiscard]] ModelPtr halfspace(Vec3 normal, double offset);
[[nodiscard]] ModelPtr quadric(const solids::Matrix4& m);
[[nodiscard]] ModelPtr prism(curves::OutlinePtr outline, double h, bool centred = false);
[[nodiscard]] ModelPtr conic(curves::OutlinePtr outline, double h, double top);
[[nodiscard]] ModelPtr revolve(curves::OutlinePtr outline, double angle);
/// Balls along cubics: x, y, z and radius of four control points for each span.
[[nodiscard]] ModelPtr sweep(std::vector<double> control);
[[nodiscard]] ModelPtr smooth(meshes::Mesh mesh);
/// Bezier nets.
[[nodiscard]] ModelPtr patches(std::vector<meshes::GivenNet> nets);
[[nodiscard]] ModelPtr moved(ModelPtr child, const Affine& map);
[[nodiscard]] ModelPtr moved(ModelPtr child, Vec3 by);
[[nodiscard]] ModelPtr join(ModelPtr a, ModelPtr b);
[[nodiscard]] ModelPtr cut(ModelPtr a, ModelPtr b);
[[nodiscard]] ModelPtr meet(ModelPtr a, ModelPtr b);

/// The library's solid. Shared parts stay shared.
[[nodiscard]] csg::Solid build(const ModelPtr& model);
/// Where p is, when its distance from the boundaries exceeds `margin`.
[[nodiscard]] Side classify(const Model& model, const RealPoint& p, Real margin);
/// As a program text, for the reports of failures.
[[nodiscard]] std::string text(const Model& model);

}  // namespace raymo::laws
