// What a law is, and how its exceptions are counted.
#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "raymo/math/affine.hpp"

namespace raymo::laws {

class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double uniform(double lo, double hi) {
        return lo + (hi - lo) * static_cast<double>(engine_() >> 11) * 0x1p-53;
    }
    int below(int n) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(n)); }
    std::uint32_t bits() { return static_cast<std::uint32_t>(engine_() >> 32); }
    bool chance(double p) { return uniform(0, 1) < p; }
    Vec3 in_cube(double r) { return {uniform(-r, r), uniform(-r, r), uniform(-r, r)}; }
    Vec3 direction() {
        for (;;) {
            const Vec3 v = in_cube(1);
            if (norm(v) > 0.1 && norm(v) < 1) return unit(v);
        }
    }
    Vec3 axis() {
        Vec3 a;
        a[below(3)] = chance(0.5) ? 1.0 : -1.0;
        return a;
    }

private:
    std::mt19937_64 engine_;
};

/// What a law has seen.
struct Tally {
    std::uint64_t rays = 0;
    std::uint64_t samples = 0;  ///< points, ends or rays that were judged
    std::uint64_t exceptions = 0;
    std::vector<std::string> reports;  ///< the first few

    void exception(std::string report) {
        ++exceptions;
        if (reports.size() < 3) reports.push_back(std::move(report));
    }
};

struct Law {
    std::string name;
    /// Number of rays of a full run.
    std::uint64_t full;
    std::function<void(std::uint64_t rays, Random& random, Tally& tally)> run;
};

void add_solid_laws(std::vector<Law>& laws);
void add_drawing_laws(std::vector<Law>& laws);
void add_tree_laws(std::vector<Law>& laws);
void add_identity_laws(std::vector<Law>& laws);
void add_start_laws(std::vector<Law>& laws);
void add_volume_laws(std::vector<Law>& laws);
void add_root_laws(std::vector<Law>& laws);
void add_blend_laws(std::vector<Law>& laws);
void add_crossing_laws(std::vector<Law>& laws);
void add_corner_laws(std::vector<Law>& laws);

}  // namespace raymo::laws
