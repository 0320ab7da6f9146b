// A list that lives where it is declared until it outgrows N items.
#pragma once

#include <algorithm>
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
    /// Leaves out what stands behind the first `count` items.
    void shrink(std::size_t count) {
        if (count_ > N && count <= N) std::copy_n(many_.begin(), count, few_.begin());
        if (count > N) many_.resize(count);
        count_ = count;
    }
    /// The last item takes the place of item i.
    void remove(std::size_t i) {
        (*this)[i] = (*this)[count_ - 1];
        shrink(count_ - 1);
    }
    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] bool empty() const { return count_ == 0; }
    [[nodiscard]] T* begin() { return count_ <= N ? few_.data() : many_.data(); }
    [[nodiscard]] T* end() { return begin() + count_; }
    [[nodiscard]] const T* begin() const { return count_ <= N ? few_.data() : many_.data(); }
    [[nodiscard]] const T* end() const { return begin() + count_; }
    [[nodiscard]] T& operator[](std::size_t i) { return begin()[i]; }
    [[nodiscard]] const T& operator[](std::size_t i) const { return begin()[i]; }

private:
    std::array<T, N> few_;
    std::vector<T> many_;
    std::size_t count_ = 0;
};

}  // namespace raymo
