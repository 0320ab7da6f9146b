// The volume is a third of the integral of S.(S_u x S_v), of degree 8 in u and in v: Gauss' five places are exact to degree 9.
#include "raymo/meshes/shell.hpp"

namespace raymo::meshes {
namespace {

constexpr std::array<double, 5> kPlace{-0.906179845938664, -0.5384693101056831, 0.0,
                                       0.5384693101056831, 0.906179845938664};
constexpr std::array<double, 5> kWeight{0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                        0.4786286704993665, 0.2369268850561891};

/// Cubic Bernstein polynomials and their derivatives at the five places of [0, 1].
struct Weights {
    std::array<std::array<double, 4>, 5> value, slope;
    Weights() {
        for (std::size_t i = 0; i < 5; ++i) {
            const double u = 0.5 + 0.5 * kPlace[i];
            const double w = 1.0 - u;
            value[i] = {w * w * w, 3.0 * w * w * u, 3.0 * w * u * u, u * u * u};
            slope[i] = {-3.0 * w * w, 3.0 * w * w - 6.0 * w * u, 6.0 * w * u - 3.0 * u * u,
                        3.0 * u * u};
        }
    }
};

}  // namespace

double volume_of(const Shell& shell) {
    static const Weights kWeights;
    // About a point of the surface, so that a solid far away loses no digits.
    const Vec3 o = shell.patches.empty() ? Vec3{} : shell.points[shell.patches[0][0]];
    double sum = 0.0;
    for (const Net& net : shell.patches) {
        double part = 0.0;
        for (std::size_t i = 0; i < 5; ++i) {
            for (std::size_t j = 0; j < 5; ++j) {
                Vec3 at, du, dv;
                for (std::size_t k = 0; k < 16; ++k) {
                    const Vec3 b = shell.points[net[k]] - o;
                    at += b * (kWeights.value[i][k / 4] * kWeights.value[j][k % 4]);
                    du += b * (kWeights.slope[i][k / 4] * kWeights.value[j][k % 4]);
                    dv += b * (kWeights.value[i][k / 4] * kWeights.slope[j][k % 4]);
                }
                part += kWeight[i] * kWeight[j] * dot(at, cross(du, dv));
            }
        }
        sum += part;
    }
    return sum / 12.0;
}

double bytes_of(const Shell& shell) {
    return static_cast<double>(sizeof(Shell) + shell.points.capacity() * sizeof(Vec3) +
                               shell.patches.capacity() * sizeof(Net));
}

}  // namespace raymo::meshes
