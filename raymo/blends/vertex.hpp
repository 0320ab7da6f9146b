// Where blended edges end: how their wedges are cut there.
#pragma once

#include <array>
#include <vector>

#include "raymo/blends/wedge.hpp"

namespace raymo::blends {

/// Whether two ends of edges are one, of edges that are blended by that size.
[[nodiscard]] bool is_same_place(Vec3 a, Vec3 b, double size);
/// Whether two faces lie in one surface, as seen at a point.
[[nodiscard]] bool is_same_surface(const Body& body, std::size_t i, std::size_t k, Vec3 at);

/// A segment that is to be blended.
struct Job {
    Segment segment;
    double extent = 0.0;        ///< of the wedge, across the edge
    double lo = 0.0, hi = 0.0;  ///< the wedge, run on beyond the ends as far as it takes
    csg::Solid solid;           ///< the wedge so far
};

/// How a wedge goes on at one end.
enum class Ending : std::uint8_t {
    flat,    ///< cut across: the edge is continued smoothly, or nothing is known
    run_on,  ///< into what the Boolean makes of it anyway
    cut,     ///< by the faces that end it
    mitre,   ///< by the third face, or with the wedge of the edge that goes on from here
};
struct EndPlan {
    Ending ending = Ending::flat;
    std::vector<std::size_t>
        faces{};  ///< that end it; of a mitre and where it runs on the third one
    std::optional<std::size_t> next;  ///< the job that it is mitred with
};
[[nodiscard]] EndPlan plan_of(const Body& body, const std::vector<Job>& jobs, std::size_t job,
                              std::size_t end);

/// A solid with a surface as its boundary near `at`: on its inner side, and as large as `reach` there.
[[nodiscard]] Result<csg::Solid> inner_side(const Surface& s, Vec3 at, double reach,
                                            SourceSpan span);
/// The leaf of a face, in the body's frame: what a free-form face has on its inner side.
[[nodiscard]] Result<csg::Solid> whole_leaf(const Body& body, std::size_t face, SourceSpan span);

/// Runs the wedge of a job on as its plans ask for.
void extend(const Body& body, std::vector<Job>& jobs, std::size_t job, double radius,
            const std::array<EndPlan, 2>& plans);

/// The wedge of a job, cut at its ends. Jobs' own solids must have been made.
[[nodiscard]] Result<csg::Solid> cut_at_ends(const Body& body, const std::vector<Job>& jobs,
                                             std::size_t job, const std::array<EndPlan, 2>& plans,
                                             SourceSpan span);

}  // namespace raymo::blends
