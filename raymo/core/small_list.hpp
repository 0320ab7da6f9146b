// A list that lives where it is declared until it outgrows N items.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace raymo {

template <class T, std::size_t N>
class SmallList {
public:
    void push_back(const T& item) {
        if (count_ < N) {
            few_[count_] = item;
        } else {
            if (count_ == N) many_.assign(few_.begin(), few_.end());
            many_.push_back(item);
        }
        ++count_;
    }
    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] bool empty() const { return count_ == 0; }
    [[nodiscard]] T* begin() { return count_ <= N ? few_.data() : many_.data(); }
    [[nodiscard]] T* end() { return begin() + count_; }
    [[nodiscard]] T& operator[](std::size_t i) { return begin()[i]; }

private:
    std::array<T, N> few_;
    std::vector<T> many_;
    std::size_t count_ = 0;
};

}  // namespace raymo
