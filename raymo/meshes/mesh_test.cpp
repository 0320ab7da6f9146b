// Meshes: what they are made of, and what is wrong with those that bound nothing (P8).
#include <doctest/doctest.h>

#include "raymo/meshes/build.hpp"
#include "raymo/meshes/obj.hpp"
#include "raymo/meshes/smooth.hpp"
#include "raymo/meshes/topology.hpp"

namespace raymo::meshes {
namespace {

const std::vector<Vec3> kCorners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                 {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
using Faces = std::vector<std::vector<double>>;
const Faces kCube{{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                  {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

/// The message of smoothing these faces of the cube's corners.
std::string refusal(const Faces& faces, std::vector<Vec3> points = kCorners) {
    const auto mesh = make_mesh(std::move(points), faces);
    if (!mesh) return mesh.error().message + " | " + mesh.error().label;
    const auto shell = smooth(*mesh);
    return shell ? "" : shell.error().message;
}

TEST_CASE("a mesh that does not close is refused, with the edge") {
    CHECK(refusal(kCube).empty());
    Faces open = kCube;
    open.pop_back();
    CHECK(refusal(open) ==
          "the mesh is open: the edge from (1, 0, 0) to (1, 1, 0) has one face only");
    Faces turned = kCube;
    turned[1] = {6, 7, 5, 4};
    CHECK(
        refusal(turned) ==
        "the faces beside the edge from (0, 0, 1) to (1, 0, 1) are listed in different directions");
    Faces thick = kCube;
    thick.push_back({0, 1, 3, 2});
    thick.push_back({0, 2, 3, 1});
    CHECK(refusal(thick) == "the edge from (0, 0, 0) to (1, 0, 0) has 4 faces");
}

TEST_CASE("two parts that share a point only are refused, with the point") {
    std::vector<Vec3> points = kCorners;
    Faces faces = kCube;
    // A second cube at the corner (1, 1, 1).
    for (int k = 1; k < 8; ++k) {
        points.push_back({1.0 + ((k & 1) != 0 ? 1 : 0), 1.0 + ((k & 2) != 0 ? 1 : 0),
                          1.0 + ((k & 4) != 0 ? 1 : 0)});
    }
    for (const auto& face : kCube) {
        std::vector<double> other;
        for (const double k : face) other.push_back(k == 0.0 ? 7.0 : k + 7.0);
        faces.push_back(other);
    }
    CHECK(refusal(faces, points) == "two parts of the mesh meet in the point (1, 1, 1) only");
}

TEST_CASE("faces that are none are refused") {
    CHECK(refusal({{0, 1}}) == "a face needs three corners or more | face 0 has 2");
    CHECK(refusal({{0, 1, 8}}) == "a face names a point that there is not | face 0 has 8");
    CHECK(refusal({{0, 1, 1.5}}) == "a face names a point that there is not | face 0 has 1.5");
    CHECK(refusal({{0, 1, 2, 1}}) == "a face has a point twice | face 0 has 1 twice");
    CHECK(refusal({}) == "a mesh needs a face | this list is empty");
    std::vector<Vec3> flat = kCorners;
    for (Vec3& p : flat) p.z = 0.0;
    CHECK(refusal(kCube, flat) == "the mesh bounds no volume");
}

TEST_CASE("faces that are all listed the other way round are turned") {
    Faces turned = kCube;
    for (auto& face : turned) std::reverse(face.begin(), face.end());
    const Shell a = smooth(make_mesh(kCorners, kCube).value()).value();
    const Shell b = smooth(make_mesh(kCorners, turned).value()).value();
    CHECK(volume_of(a) == doctest::Approx(volume_of(b)).epsilon(1e-12));
    CHECK(volume_of(b) > 0.0);
}

TEST_CASE("a crease needs an edge") {
    const std::vector<Edge> none{{0, 7}};
    CHECK(creased(make_mesh(kCorners, kCube).value(), none).error().label ==
          "there is none from (0, 0, 0) to (1, 1, 1)");
}

TEST_CASE("common meshes close, and have the volume that their faces bound") {
    CHECK(volume6(box_mesh({2, 3, 4}, {1, 2, 3})) == doctest::Approx(6 * 24));
    CHECK(smooth(box_mesh({2, 3, 4}, {1, 2, 3})));
    // Clockwise or not, the polygon is the same.
    for (const bool turned : {false, true}) {
        std::vector<Vec2> points{{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 3}, {0, 3}};
        if (turned) std::reverse(points.begin(), points.end());
        const Mesh mesh = extrude_mesh(points, 2.0, 3).value();
        CHECK(volume6(mesh) > 0.0);
        CHECK(smooth(mesh));
    }
    std::vector<std::vector<Vec3>> rows;
    for (int i = 0; i < 4; ++i) {
        const double r = i == 0 || i == 3 ? 0.0 : 1.0;
        rows.push_back(
            {{r, 0, double(i)}, {0, r, double(i)}, {-r, 0, double(i)}, {0, -r, double(i)}});
    }
    const Mesh tips = grid_mesh(rows, Closing::rows).value();
    CHECK(tips.face_count() == 12);
    CHECK(smooth(tips));
    rows.resize(1);
    CHECK_FALSE(grid_mesh(rows, Closing::rows));
}

TEST_CASE("OBJ: points, faces, and lines that are wrong") {
    const auto read = [](std::string_view text) {
        return read_obj(text, [](double) { return true; });
    };
    const auto tetrahedron = read(
        "# a tetrahedron\r\nmtllib x.mtl\nv 0 0 0\nv 1 0 0 1.0\nv 0 +1 0\nvn 0 0 1\nv 0 0 1e0\n"
        "f 1 3 2\nf 1/1 2/2/2 \\\n 4//3\ns off\nf -1 -2 -4\nf 2 3 4");
    REQUIRE(tetrahedron);
    CHECK(tetrahedron->face_count() == 4);
    CHECK(volume6(*tetrahedron) == doctest::Approx(1.0));
    const auto wrong = [&](std::string_view text) { return read(text).error().message; };
    CHECK(wrong("v 0 0") ==
          "line 1 of the file can not be read: a point has less than three numbers");
    CHECK(wrong("\nv 0 zero 0") == "line 2 of the file can not be read: \"zero\" is not a number");
    CHECK(wrong("v 0 0 0\nf 1 2 3") ==
          "line 2 of the file can not be read: there is no point 2 before it");
    CHECK(wrong("v 0 0 0\nf 1 -9223372036854775808 3") ==
          "line 2 of the file can not be read: there is no point -9223372036854775808 before it");
    CHECK(wrong("v 0 0 0\nf 0 1 1") ==
          "line 2 of the file can not be read: \"0\" is not the number of a point");
    CHECK(wrong("PNG") == "there are no faces in the file");
    CHECK(wrong("v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3") ==
          "a point is too far away to be computed with");
    const auto stopped = read_obj("v 0 0 0", [](double) { return false; });
    CHECK(stopped.error().code == ErrorCode::cancelled);
}

}  // namespace
}  // namespace raymo::meshes
