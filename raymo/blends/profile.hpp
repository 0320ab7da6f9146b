// Free-form curves of the plane as boundaries with a distance: smooth runs of a contour's spans.
#pragma once

#include <memory>
#include <vector>

#include "raymo/curves/outline.hpp"

namespace raymo::blends {

/// Spans end to end without a corner. An open run goes on straight beyond its ends.
class Run {
public:
    /// `spans`: at least one, each beginning where the one before it ends.
    Run(std::vector<curves::Span2> spans, bool is_closed);

    struct Nearest {
        Vec2 point;
        Vec2 normal;      ///< unit, to the right of the run
        double distance;  ///< positive on the right
    };
    /// The nearest point. On the run's evolute one of several. Cost: about 1 us for each hundred spans.
    [[nodiscard]] Nearest nearest(Vec2 p) const;

    [[nodiscard]] bool is_closed() const { return is_closed_; }
    /// Points along it, eight for each span.
    [[nodiscard]] const std::vector<Vec2>& samples() const { return samples_; }

private:
    struct Jet {
        Vec2 value, first, second;
    };
    [[nodiscard]] Jet jet(double u) const;
    [[nodiscard]] double end() const { return static_cast<double>(spans_.size()); }

    std::vector<curves::Span2> spans_;
    std::vector<Vec2> samples_;
    bool is_closed_;
};

using RunPtr = std::shared_ptr<const Run>;

}  // namespace raymo::blends
