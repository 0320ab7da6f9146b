#include "raymo/trace/tables.hpp"

#include <bit>

#include "raymo/trace/lane_kinds.hpp"

namespace raymo::trace {
namespace {

/// Mixes `value` into `hash` (the finaliser of SplitMix64).
std::uint64_t mix(std::uint64_t hash, std::uint64_t value) {
    hash ^= value + 0x9e3779b97f4a7c15ULL;
    hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9ULL;
    hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebULL;
    return hash ^ (hash >> 31);
}
std::uint64_t mix_number(std::uint64_t hash, double value) {
    return mix(hash, std::bit_cast<std::uint64_t>(value));
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
    std::uint64_t hash = mix(frame.type, frame.index);
    for (const Vec3& row : frame.to_local.row) {
        for (int i = 0; i < 3; ++i) hash = mix_number(hash, row[i] + 0.0);
    }
    const auto [first, last] = frame_index_.equal_range(hash);
    for (auto it = first; it != last; ++it) {
        Frame& known = frames_[it->second];
        if (known.to_local == frame.to_local && known.type == frame.type &&
            known.index == frame.index) {
            known.error = max(known.error, frame.error);
            return it->second;
        }
    }
    const auto index = static_cast<std::uint32_t>(frames_.size());
    frames_.push_back(frame);
    frame_index_.emplace(hash, index);
    return index;
}

std::uint32_t Tables::look(const Look& look) {
    std::uint64_t hash = mix(look.material, look.primitive);
    hash = mix(hash, (std::uint64_t{look.span.file} << 32) + look.span.begin);
    hash = mix(hash, std::uint64_t{look.span.end} * 8 + (look.literal_negated ? 4U : 0U) +
                         (look.cuts ? 2U : 0U) + (look.borrows ? 1U : 0U));
    const auto [first, last] = look_index_.equal_range(hash);
    for (auto it = first; it != last; ++it) {
        if (data_.looks[it->second] == look) return it->second;
    }
    const auto index = static_cast<std::uint32_t>(data_.looks.size());
    data_.looks.push_back(look);
    look_index_.emplace(hash, index);
    return index;
}

}  // namespace raymo::trace
