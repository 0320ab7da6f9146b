// Free-form curves of the plane as boundaries with a distance: smooth runs of a contour's spans.
#pragma once

#include <functional>
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
        double at;        ///< parameter: span by span, each from 0 to 1; beyond an end that end's
    };
    /// The nearest point. On the run's evolute one of several. Cost: about 1 us for each hundred spans.
    [[nodiscard]] Nearest nearest(Vec2 p) const;

    /// The point that is seen at the least angle from p, x and y in the plane and z above it, by an eye `height` below the
    /// plane's origin; on the run itself.
    struct Seen {
        Vec2 point;
        Vec2 normal;  ///< unit, to the right of the run
    };
    [[nodiscard]] Seen seen(Vec3 p, double height) const;

    /// Where a function of the plane changes its sign along the run and, for 2^-6 of its size, straight on beyond its
    /// ends. The function may change by no more than the way, as distances do. Two changes that are closer than 1/64 of the
    /// way between two samples may be missed.
    [[nodiscard]] std::vector<Vec2> crossings(const std::function<double(Vec2)>& distance) const;

    /// Appends the run from one parameter to another, moved to its right by `by`, which must be much less than its bends: by
    /// cubics with its tangents, which are off by less than 2^-30 of the size of polynomial spans and 2^-24 of rational ones.
    /// Backwards where `from` > `to`; of a closed run the shorter way round.
    void append_moved(double from, double to, double by, curves::Curve& curve) const;

    /// The image under a map that keeps lengths; where that is a reflection, run through from its end, so that its right
    /// side stays the right one.
    [[nodiscard]] Run mapped(const Affine2& map) const;
    /// What is to the left of the run near the place nearest to `p`, as far as `reach`: of the part about that place which
    /// turns by less than 60 degrees to either side, and goes on straight there.
    [[nodiscard]] curves::Outline left_of(Vec2 p, double reach) const;

    [[nodiscard]] bool is_closed() const { return is_closed_; }
    /// The radius of a circle that holds it.
    [[nodiscard]] double size() const { return size_; }
    /// The least distance between two samples next to each other.
    [[nodiscard]] double grain() const { return grain_; }
    /// Points along it, eight for each span.
    [[nodiscard]] const std::vector<Vec2>& samples() const { return samples_; }

private:
    struct Jet {
        Vec2 value, first, second;
    };
    [[nodiscard]] Jet jet(double u) const;
    [[nodiscard]] double end() const { return static_cast<double>(spans_.size()); }
    /// The run's place and unit tangent, moved to its right.
    struct Moved {
        Vec2 point, way;
    };
    [[nodiscard]] Moved moved(double u, double by) const;

    std::vector<curves::Span2> spans_;
    std::vector<Vec2> samples_;
    double size_ = 0.0;
    double grain_ = 0.0;
    bool is_closed_;
};

using RunPtr = std::shared_ptr<const Run>;

}  // namespace raymo::blends
