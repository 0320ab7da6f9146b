// What a chamfer or a conic is in the plane across the ball's path.
//
// A chamfer is straight from contact to contact, and goes on straight beyond both faces: there the wedge ends by itself. A conic
// touches the faces at the contacts and ends there.
#pragma once

#include <span>
#include <vector>

#include "raymo/blends/spine.hpp"

namespace raymo::blends {

class ProfileCurve {
public:
    /// Of a chamfer or conic; `depth`: how far beyond the faces it ends [mm].
    ProfileCurve(const Spine& spine, const Form& form, double depth)
        : spine_(spine), form_(form), depth_(depth) {}

    /// Whether it is one line, so that nothing but its ends has to be asked for.
    [[nodiscard]] bool is_straight() const { return form_.profile == Profile::chamfer; }
    /// The parameter at the part v of a stretch, so that both its halves are alike.
    [[nodiscard]] double part(double from, double to, double v) const;
    /// The points at parameters from 0 (face a) to 1 (face b), ascending; appended. False: there are none, or sections cross
    /// there.
    [[nodiscard]] bool append_points(const Station& station, std::span<const double> at,
                                     std::vector<Vec3>& out) const;
    /// Beyond face a and face b.
    struct Ends {
        Vec3 a, b;
    };
    /// Empty where it is too flat to end beyond both.
    [[nodiscard]] std::optional<Ends> ends(const Station& station) const;

private:
    [[nodiscard]] bool append_conic_points(const Station& station, std::span<const double> at,
                                           std::vector<Vec3>& out) const;

    const Spine& spine_;
    const Form& form_;
    double depth_;
};

}  // namespace raymo::blends
