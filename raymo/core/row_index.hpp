// Tables in which what is equal is stored once.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace raymo {

/// Mixes `value` into `hash` (the finaliser of SplitMix64).
[[nodiscard]] constexpr std::uint64_t mix(std::uint64_t hash, std::uint64_t value) {
    hash ^= value + 0x9e3779b97f4a7c15ULL;
    hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9ULL;
    hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebULL;
    return hash ^ (hash >> 31);
}

/// Adds numbers up to a value to be mixed: the bits of each, times an odd factor of its own, so that the products do not wait
/// for each other. Both zeros count as one.
class NumberSum {
public:
    void add(double number) {
        const auto bits = std::bit_cast<std::uint64_t>(number + 0.0);
        sum_ += (bits ^ (bits >> 29)) * factor_;
        factor_ += 0xd1b54a32d192ed02ULL;
    }
    [[nodiscard]] std::uint64_t value() const { return sum_; }

private:
    std::uint64_t sum_ = 0;
    std::uint64_t factor_ = 0x9e3779b97f4a7c15ULL;
};

/// Finds the rows of a table by the hashes they were added with: open addressing, at most half full, so that a search
/// reads one place of memory and adding a row allocates nothing.
class RowIndex {
public:
    static constexpr std::uint32_t kNoRow = 0xffffffffU;

    /// The row with this hash for which `is_it(row)`; kNoRow: there is none.
    template <class IsIt>
    [[nodiscard]] std::uint32_t find(std::uint64_t hash, IsIt&& is_it) const {
        if (places_.empty()) return kNoRow;
        for (std::size_t at = hash & mask();; at = (at + 1) & mask()) {
            const Place& place = places_[at];
            if (place.row == kNoRow) return kNoRow;
            if (place.tag == tag_of(hash) && is_it(place.row)) return place.row;
        }
    }
    void add(std::uint64_t hash, std::uint32_t row) {
        if (2 * (used_ + 1) > places_.size()) {
            const std::vector<Place> before = std::move(places_);
            places_.assign(before.empty() ? 16 : 2 * before.size(), {});
            for (const Place& place : before) {
                if (place.row != kNoRow) put(place);
            }
        }
        put({tag_of(hash), row});
        ++used_;
    }

private:
    struct Place {
        std::uint32_t tag = 0;  ///< the hash as far as it is kept
        std::uint32_t row = kNoRow;
    };
    [[nodiscard]] static std::uint32_t tag_of(std::uint64_t hash) {
        return static_cast<std::uint32_t>(hash);
    }
    [[nodiscard]] std::size_t mask() const { return places_.size() - 1; }
    void put(Place place) {
        std::size_t at = place.tag & mask();
        while (places_[at].row != kNoRow) at = (at + 1) & mask();
        places_[at] = place;
    }

    std::vector<Place> places_;  ///< a power of two of them, at most 2^32
    std::size_t used_ = 0;
};

}  // namespace raymo
