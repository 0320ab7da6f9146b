#include "raymo/trace/tables.hpp"

#include "raymo/trace/lane_kinds.hpp"

namespace raymo::trace {
namespace {

std::uint64_t sum_of(const Mat3& m) {
    NumberSum sum;
    for (const Vec3& row : m.row) {
        for (int i = 0; i < 3; ++i) sum.add(row[i]);
    }
    return sum.value();
}

}  // namespace

LeafKind kind_of(std::uint32_t type) {
    LeafKind kind = LeafKind::single_rays;
    std::uint32_t at = 0;
    solids::Inventory::for_each([&]<class P>() {
        if (at++ != type) return;
        constexpr int kSpans = kSpansInLanes<typename P::Kernel>;
        kind = kSpans == 0   ? LeafKind::single_rays
               : kSpans == 1 ? LeafKind::one_span
                             : LeafKind::spans;
    });
    return kind;
}

std::uint32_t Tables::kernel(const solids::AnyKernel& kernel) {
    return std::visit(
        [&]<class K>(const K& k) {
            auto& table = std::get<std::vector<K>>(data_.kernels);
            // Equal kernels mostly come one after the other; a repeated kernel further back is only
            // stored again.
            constexpr std::size_t kLookBack = 16;
            const std::size_t stop = table.size() > kLookBack ? table.size() - kLookBack : 0;
            for (std::size_t i = table.size(); i-- > stop;) {
                if (table[i] == k) return static_cast<std::uint32_t>(i);
            }
            table.push_back(k);
            return static_cast<std::uint32_t>(table.size() - 1);
        },
        kernel);
}

std::uint32_t Tables::frame(const Frame& frame) {
    const std::uint64_t hash =
        mix(sum_of(frame.to_local), (std::uint64_t{frame.type} << 32) + frame.index);
    const std::uint32_t found = frame_index_.find(hash, [&](std::uint32_t row) {
        const Frame& known = frames_[row];
        return known.to_local == frame.to_local && known.type == frame.type &&
               known.index == frame.index;
    });
    if (found != RowIndex::kNoRow) {
        frames_[found].error = max(frames_[found].error, frame.error);
        return found;
    }
    const auto index = static_cast<std::uint32_t>(frames_.size());
    frames_.push_back(frame);
    frame_index_.add(hash, index);
    return index;
}

std::uint32_t Tables::look(const Look& look) {
    std::uint64_t hash = mix(look.material, look.primitive);
    hash = mix(hash, (std::uint64_t{look.span.file} << 32) + look.span.begin);
    hash = mix(hash, std::uint64_t{look.span.end} * 8 + (look.literal_negated ? 4U : 0U) +
                         (look.cuts ? 2U : 0U) + (look.borrows ? 1U : 0U));
    const std::uint32_t found =
        look_index_.find(hash, [&](std::uint32_t row) { return data_.looks[row] == look; });
    if (found != RowIndex::kNoRow) return found;
    const auto index = static_cast<std::uint32_t>(data_.looks.size());
    data_.looks.push_back(look);
    look_index_.add(hash, index);
    return index;
}

}  // namespace raymo::trace
