// The side of the sectors (sector.hpp) that is away from the edge: from beyond face a to beyond face b.
//
// Of a ball's sectors it is made of two ruled surfaces, from the ball's path through the contacts; what is within the ball is not
// the sectors' concern. Their ends are off by d at a contact, which opens or closes a gap of d^2 / 2 r: 2^-16 of the radius makes that
// 2^-33.
//
// A chamfer or a conic is itself this side: patches through its points in the planes across the path (profile_curve.hpp, fit.hpp),
// within 2^-30 of the radius, of conics 2^-28. They are strips along the path. A chamfer is one strip that goes on beyond the faces; a conic
// has as many as its bends ask for, and walls along the faces' normals from its contacts on.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "raymo/blends/fit.hpp"
#include "raymo/blends/profile_curve.hpp"

namespace raymo::blends {

/// The near side in the plane across the path.
struct NearPlace {
    Vec3 ends[2];              ///< beyond face a and face b
    std::vector<Vec3> points;  ///< of a profile: at the places of fit.hpp, strip by strip
    std::vector<Cubic>
        across;  ///< from end to end; none where the sectors have their tip in the centre
};

class NearSide {
public:
    virtual ~NearSide() = default;
    /// False: not at this station.
    [[nodiscard]] virtual bool place(const Station& station, NearPlace& out) const = 0;
    /// Appends the patches between two places with `middle` between, and sets the curves of the ends. False: it is
    /// too long for what happens there; what has been appended does not count then.
    [[nodiscard]] virtual bool append(const Station& from, const NearPlace& from_near,
                                      const Station& middle, const NearPlace& middle_near,
                                      const Station& to, const NearPlace& to_near, Cubic ends[2],
                                      std::vector<meshes::GivenNet>& nets) const = 0;
};

/// Of a ball; `depth`: how far beyond the contacts, as part of the radius.
[[nodiscard]] std::unique_ptr<NearSide> ball_side(const Spine& spine, double depth);
/// Of a chamfer or conic. `coarse`: stations that tell how a conic bends, and so how many strips it takes for their curves across
/// to be off by no more than `part` of what the patches may be. Null: it can not be followed at one of them.
[[nodiscard]] std::unique_ptr<NearSide> profile_side(const Spine& spine, const Form& form,
                                                     double depth,
                                                     const std::vector<Station>& coarse,
                                                     double part);

/// The patch between two curves: points of the second parameter in equal parts from one to the other.
[[nodiscard]] meshes::GivenNet ruled(const Cubic& from, const Cubic& to);
/// The parabola through three points, at 0, 1/2 and 1.
[[nodiscard]] Cubic parabola(Vec3 p, Vec3 middle, Vec3 q);

}  // namespace raymo::blends
