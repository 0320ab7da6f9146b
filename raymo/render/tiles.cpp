#include "raymo/render/tiles.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace raymo::render {
namespace {

/// Bits of x moved apart: bit i to bit 2 i.
std::uint64_t spread(std::uint32_t x) {
    std::uint64_t s = x;
    s = (s | (s << 16U)) & 0x0000ffff0000ffffULL;
    s = (s | (s << 8U)) & 0x00ff00ff00ff00ffULL;
    s = (s | (s << 4U)) & 0x0f0f0f0f0f0f0f0fULL;
    s = (s | (s << 2U)) & 0x3333333333333333ULL;
    return (s | (s << 1U)) & 0x5555555555555555ULL;
}

}  // namespace

std::vector<Rect> tiles_of(int width, int height, int size) {
    std::vector<Rect> tiles;
    for (int y = 0; y < height; y += size) {
        for (int x = 0; x < width; x += size) {
            tiles.push_back({x, y, std::min(x + size, width), std::min(y + size, height)});
        }
    }
    const auto code = [size](const Rect& r) {
        return spread(static_cast<std::uint32_t>(r.x0 / size)) |
               (spread(static_cast<std::uint32_t>(r.y0 / size)) << 1U);
    };
    std::sort(tiles.begin(), tiles.end(),
              [&](const Rect& a, const Rect& b) { return code(a) < code(b); });
    return tiles;
}

bool Crew::run(const std::vector<Rect>& tiles, double from, double to,
               const std::function<void(const Rect&, RayShader&)>& work) {
    done_ = 0;
    executor_->for_each(tiles.size(), [&](std::size_t index, std::size_t worker) {
        if (progress_->cancelled()) return;
        std::unique_ptr<RayShader>& shader = shaders_[worker];
        if (!shader) shader = std::make_unique<RayShader>(*stage_);
        work(tiles[index], *shader);
        done_.fetch_add(1, std::memory_order_relaxed);
        report(tiles.size(), from, to);
    });
    return !progress_->cancelled();
}

/// One worker at a time reports, and reads the count when it is its turn, so that the fraction
/// never decreases. The others need not wait.
void Crew::report(std::size_t total, double from, double to) {
    if (reporting_.test_and_set(std::memory_order_acquire)) return;
    const double part =
        static_cast<double>(done_.load(std::memory_order_relaxed)) / static_cast<double>(total);
    progress_->report(from + (to - from) * part);
    reporting_.clear(std::memory_order_release);
}

trace::RayCounts Crew::counts() const {
    trace::RayCounts sum;
    for (const auto& shader : shaders_) {
        if (!shader) continue;
        const trace::RayCounts one = shader->counts();
        sum.primary += one.primary;
        sum.shadow += one.shadow;
        sum.secondary += one.secondary;
        sum.boxes += one.boxes;
        sum.leaves += one.leaves;
    }
    return sum;
}

bool differ(const Signature& a, const float* light_a, const Signature& b, const float* light_b) {
    if (a.face != b.face) return true;
    if (a.face != 0) {
        const int bend =
            a.normal[0] * b.normal[0] + a.normal[1] * b.normal[1] + a.normal[2] * b.normal[2];
        constexpr int kCos45 = 11400;  // 127^2 cos 45 degrees
        if (bend < kCos45) return true;
    }
    // A step of s in the square roots is one of s (sqrt x + sqrt y) in the values x, y, whose
    // square lies between s^2 (x + y) and 2 s^2 (x + y).
    constexpr float kStep = 1.5F / (16.0F * 16.0F);
    for (int i = 0; i < 3; ++i) {
        const float d = light_a[i] - light_b[i];
        if (d * d > kStep * std::min(light_a[i] + light_b[i], 2.0F) + 1e-6F) return true;
    }
    return false;
}

float step_between(const float* light_a, const float* light_b) {
    float most = 0.0F;
    for (int i = 0; i < 3; ++i) {
        const float a = std::sqrt(std::clamp(light_a[i], 0.0F, 1.0F));
        const float b = std::sqrt(std::clamp(light_b[i], 0.0F, 1.0F));
        most = std::max(most, std::fabs(a - b));
    }
    return most;
}

}  // namespace raymo::render
