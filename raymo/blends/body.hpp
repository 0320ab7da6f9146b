// A solid laid open for blending: its leaves with their faces, all in one frame, and the Boolean that joins them.
#pragma once

#include <string>
#include <vector>

#include "raymo/blends/surface.hpp"
#include "raymo/csg/model.hpp"

namespace raymo::blends {

/// A face of a leaf: part of one of the surfaces that can be blended.
struct Face {
    Surface surface;
    double side = 1.0;  ///< -1: the leaf lies on the surface's outer side
    std::uint32_t leaf = 0;
    std::string_view name;  ///< "side", "top"
};

/// A leaf, in the frame of the body.
struct Leaf {
    csg::Solid solid;  ///< the leaf's own node
    Affine map;        ///< from the kernel's frame to the body's
    Affine inverse;
    Aabb box;
    Aabb near;  ///< the box, grown by much more than rounding
    csg::MaterialId material = csg::kNoMaterial;
    std::size_t operand = 0;  ///< of which operand it is part
    bool is_blend = false;    ///< part of a blend made before, not a solid that the user wrote
    std::size_t first_face = 0;
    std::size_t face_count = 0;
    /// What can not be blended about it: "its wall is a free-form curve"; empty when all of its faces are told.
    std::string_view unknown;
};

class Body {
public:
    /// `operands` joined by `op`. Error: limit, when there are more than kMostLeaves.
    [[nodiscard]] static Result<Body> make(csg::Op op, const std::vector<csg::Solid>& operands);
    static constexpr std::size_t kMostLeaves = 1024;

    [[nodiscard]] const std::vector<Leaf>& leaves() const { return leaves_; }
    [[nodiscard]] const std::vector<Face>& faces() const { return faces_; }
    /// Of the operands joined.
    [[nodiscard]] const Aabb& box() const { return box_; }
    /// Where a point is, as its leaves decide it: on when a leaf on whose boundary it lies could change the answer.
    [[nodiscard]] solids::Where where(Vec3 p) const { return where(p, 0, steps_.size()); }
    /// What it takes to tell that, in units of some 100 ns: most leaves are elsewhere.
    [[nodiscard]] double where_work() const {
        return 15.0 + 0.2 * static_cast<double>(leaves_.size());
    }
    /// What the Boolean makes of a place of which it is known where it is with respect to each leaf.
    [[nodiscard]] solids::Where where(const std::vector<solids::Where>& in_leaves) const;
    /// The same of one of the operands alone.
    [[nodiscard]] solids::Where where_in_operand(std::size_t operand, Vec3 p) const {
        return where(p, operand == 0 ? 0 : ends_[operand - 1], ends_[operand]);
    }
    /// Whether a point lies on the boundary of a face's leaf, or within `margin` of it.
    [[nodiscard]] bool is_on(const Face& face, Vec3 p, double margin = 0.0) const;
    /// "the top of the block"; "an earlier blend".
    [[nodiscard]] std::string name_of(const Face& face) const;
    [[nodiscard]] std::string name_of(const Leaf& leaf) const;  ///< "the block"

private:
    /// The Boolean in postfix form: a leaf, or an operation on the `count` values before it.
    struct Step {
        bool is_leaf = true;
        csg::Op op = csg::Op::unite;
        std::uint32_t count = 0;  ///< or the number of the leaf
    };
    [[nodiscard]] Result<void> add(const csg::Solid& solid, std::size_t operand);
    [[nodiscard]] solids::Where where(Vec3 p, std::size_t begin, std::size_t end) const;
    /// in_leaf(i) tells of leaf i.
    template <class InLeaf>
    [[nodiscard]] solids::Where combined(std::size_t begin, std::size_t end,
                                         InLeaf&& in_leaf) const;

    std::vector<Leaf> leaves_;
    std::vector<Face> faces_;
    std::vector<Step> steps_;
    std::vector<std::size_t> ends_;  ///< of the operands' steps
    Aabb box_;
};

/// Appends the faces of a leaf under a map that takes its kernel's frame to the body's; what can not be told goes to
/// `leaf.unknown`. A cylinder that is scaled to an ellipse, for one, has only its two ends.
void add_faces(Leaf& leaf, std::uint32_t index, std::vector<Face>& faces);

}  // namespace raymo::blends
