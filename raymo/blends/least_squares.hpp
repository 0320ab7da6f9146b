// Least squares in a few unknowns.
#pragma once

#include <array>
#include <cstddef>

namespace raymo::blends {

/// Sums of squares of linear conditions on N unknowns. Of all solutions it is the one nearest to 0, by Tikhonov's term: what no
/// condition tells stays as it is.
template <std::size_t N>
class LeastSquares {
public:
    /// A condition: its coefficients, and behind them the right side.
    using Row = std::array<double, N + 1>;

    LeastSquares() {
        for (std::size_t i = 0; i < N; ++i) m_[i][i] = kTikhonov;
    }
    /// `square`: the square of the condition's weight.
    void add(const Row& row, double square = 1.0) {
        for (std::size_t i = 0; i < N; ++i) {
            const double scaled = square * row[i];
            if (scaled == 0.0) continue;
            for (std::size_t j = 0; j <= N; ++j) m_[i][j] += scaled * row[j];
        }
    }
    /// By Gauss' elimination; the matrix is positive definite, so without pivots.
    [[nodiscard]] std::array<double, N> solved() {
        for (std::size_t i = 0; i < N; ++i) {
            for (std::size_t k = i + 1; k < N; ++k) {
                const double part = m_[k][i] / m_[i][i];
                for (std::size_t j = i; j <= N; ++j) m_[k][j] -= part * m_[i][j];
            }
        }
        std::array<double, N> x{};
        for (std::size_t i = N; i-- > 0;) {
            double sum = m_[i][N];
            for (std::size_t j = i + 1; j < N; ++j) sum -= m_[i][j] * x[j];
            x[i] = sum / m_[i][i];
        }
        return x;
    }

private:
    /// Far less than what a curve of any use tells, far more than roundings.
    static constexpr double kTikhonov = 0x1p-40;
    std::array<Row, N> m_{};
};

}  // namespace raymo::blends
