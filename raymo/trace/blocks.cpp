#include "raymo/trace/blocks.hpp"

#include <algorithm>

namespace raymo::trace {
namespace {

template <class F>
void with_kernel(const KernelTables& kernels, const Frame& frame, F&& f) {
    std::uint32_t type = 0;
    solids::Inventory::for_each([&]<class P>() {
        if (type++ != frame.type) return;
        if constexpr (solids::BlockKernel<typename P::Kernel>)
            f(std::get<std::vector<typename P::Kernel>>(kernels)[frame.index]);
    });
}

void put(const solids::SpanEnd& end, std::size_t k, int lane, solids::SpanBlock::End& out) {
    out.s[k][lane] = end.s;
    out.error[k][lane] = end.error;
    out.face[k][lane] = end.face;
}

}  // namespace

bool answers_blocks(std::uint32_t type) {
    bool answers = false;
    std::uint32_t at = 0;
    solids::Inventory::for_each([&]<class P>() {
        if (at++ == type) answers = solids::BlockKernel<typename P::Kernel>;
    });
    return answers;
}

void block_spans(const KernelTables& kernels, const Frame& frame, const solids::RayBlock& rays,
                 std::uint32_t asked, solids::SpanBlock& out) {
    with_kernel(kernels, frame, [&](const auto& kernel) {
        kernel.spans(rays, asked, out);
        for (std::uint32_t rest = out.left_over; rest != 0; rest &= rest - 1) {
            const int i = __builtin_ctz(rest);
            solids::SpanList spans;
            kernel.spans_in_full(
                {rays.o[0][i], rays.o[1][i], rays.o[2][i], rays.d[0][i], rays.d[1][i], rays.d[2][i],
                 rays.e[0][i], rays.e[1][i], rays.e[2][i], rays.dd[i], rays.from[i]},
                spans);
            if (spans.touched() || spans.degenerate() || spans.size() > solids::kSweptSpans)
                continue;
            out.left_over &= ~(1U << i);
            for (std::size_t k = 0; k < spans.size(); ++k) {
                put(spans[k].enter, k, i, out.enter);
                put(spans[k].exit, k, i, out.exit);
                out.valid[k] |= 1U << i;
                out.count = std::max(out.count, static_cast<int>(k) + 1);
            }
        }
    });
}

void spans_in_full(const KernelTables& kernels, const Frame& frame,
                   const solids::LocalRay<double>& ray, solids::SpanList& out) {
    with_kernel(kernels, frame, [&](const auto& kernel) { kernel.spans_in_full(ray, out); });
}

void block_normals(const KernelTables& kernels, const Frame& frame, solids::PlaceBlock& places,
                   std::uint32_t asked) {
    with_kernel(kernels, frame, [&](const auto& kernel) { kernel.normals(places, asked); });
}

}  // namespace raymo::trace
