// A region of the plane made ready for questions: its boundary as convex, monotone pieces in a tree of boxes.
//
// The curves of an outline are cut where they turn back in x or y and where they bend the other way. Each piece then lies
// within the box of its ends, and a line meets it at most twice. Where pieces are cut, and where curves close, neighbours
// share their end point bit for bit, so that a sign that is asked for there has one answer.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "raymo/core/result.hpp"
#include "raymo/curves/bernstein.hpp"
#include "raymo/curves/outline.hpp"

namespace raymo::curves {

/// Where a point of the plane is.
enum class Side : std::uint8_t { out, on, in };

/// A rational cubic of an outline, in the region's frame.
struct Piece : Span2 {
    /// The piece that begins where this one ends; or, where pieces on an axis are left out, behind them.
    std::uint32_t next = 0;
    std::uint32_t previous = 0;  ///< and the one that ends where this begins
    /// Number of the smooth stretch that it is part of: between two corners, and without another piece of the same curve that
    /// meets this one, but its neighbours.
    std::uint32_t run = 0;
    double bend = 0.0;            ///< largest second difference of its coefficients
    bool ends_in_corner = false;  ///< the tangent turns where it ends
};

class Region {
public:
    /// Of the tree of boxes. Nodes stand before what is below them.
    struct Node {
        Box2 box;
        std::uint32_t skip = 0;   ///< node to go on with when the box is missed
        std::uint32_t first = 0;  ///< pieces
        std::uint32_t count = 0;  ///< 0: an inner node
    };

    /// Made from closed curves, by p -> (p - centre) scale. `scale` should be a power of two, so that it rounds nothing.
    /// Error: bad_argument when no point is enclosed or a coordinate is not finite. Cost: about 1 us a span.
    [[nodiscard]] static Result<std::shared_ptr<const Region>> make(const Outline& outline,
                                                                    Vec2 centre, double scale);

    /// The same for a half-plane x >= 0 that is turned about its edge: pieces on the edge are left out, as they sweep nothing
    /// and bound nothing. `where` then tells of points with x >= 0 only.
    [[nodiscard]] static Result<std::shared_ptr<const Region>> make_beside_axis(
        const Outline& outline, Vec2 centre, double scale);

    [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }
    [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
    [[nodiscard]] Fill fill() const { return fill_; }
    /// Whether a point is inside about which the curves turn `winding` times.
    [[nodiscard]] bool encloses(int winding) const {
        return fill_ == Fill::even_odd ? (winding & 1) != 0 : winding != 0;
    }
    [[nodiscard]] const Box2& box() const { return nodes_.front().box; }
    /// Number of smooth stretches.
    [[nodiscard]] std::uint32_t runs() const { return runs_; }
    /// Memory it takes.
    [[nodiscard]] double bytes() const {
        return static_cast<double>(sizeof(Region) + pieces_.capacity() * sizeof(Piece) +
                                   nodes_.capacity() * sizeof(Node));
    }

    /// Calls visit(piece index) for all pieces in boxes for which meets(box) holds all the way down.
    template <class Meets, class Visit>
    void walk(Meets&& meets, Visit&& visit) const {
        for (std::uint32_t i = 0; i < nodes_.size();) {
            const Node& node = nodes_[i];
            if (!meets(node.box)) {
                i = node.skip;
                continue;
            }
            for (std::uint32_t k = node.first; k < node.first + node.count; ++k) visit(k);
            ++i;
        }
    }

    /// `on` when the boundary comes within `e` of p in x and in y.
    [[nodiscard]] Side where(Vec2 p, Vec2 e) const;
    /// +1 where the region lies to the left of one of its pieces, -1 to the right; 0 where both sides are alike.
    [[nodiscard]] double left_side(const Piece& piece) const;
    /// The largest n.p of all points p of the curves: a bound for the region's, and exact unless a curve lies inside.
    [[nodiscard]] double support(Vec2 n) const;
    /// A normal, to the right of the curve, at the point nearest to p of the stretches that have number `run` when they are
    /// numbered modulo `modulus`. Of any length > 0.
    [[nodiscard]] Vec2 normal(Vec2 p, std::uint32_t run, std::uint32_t modulus) const;
    /// Area enclosed by the curves, counted with their senses: the region's, up to its sign, when there is one curve that
    /// does not cross itself.
    [[nodiscard]] double signed_area() const;

    friend bool operator==(const Region& a, const Region& b);

private:
    [[nodiscard]] static Result<std::shared_ptr<const Region>> make(const Outline& outline,
                                                                    Vec2 centre, double scale,
                                                                    bool beside_axis);
    /// Whether nothing is enclosed: both sides of all pieces are alike.
    [[nodiscard]] bool is_flat() const;
    void add_curve(const Curve& curve, Vec2 centre, double scale, bool beside_axis);
    void number_runs();
    /// `borders`: of the stretches, where pieces begin.
    void number_runs(const std::vector<bool>& borders);
    /// Whether a piece may meet one of its stretch that is not its neighbour.
    [[nodiscard]] bool meets_its_run(std::uint32_t i) const;
    void add_node(std::uint32_t first, std::uint32_t end);

    std::vector<Piece> pieces_;
    std::vector<Node> nodes_;
    std::uint32_t runs_ = 0;
    Fill fill_ = Fill::even_odd;
};

using RegionPtr = std::shared_ptr<const Region>;

/// The box of a piece's control points, which is that of its ends when it is monotone.
[[nodiscard]] Box2 box_of(const Span2& piece);
/// A tangent at u, of any length; zero only where the piece is a point.
[[nodiscard]] Vec2 tangent(const Span2& piece, double u);
/// The point at u.
[[nodiscard]] Vec2 point_at(const Span2& piece, double u);

}  // namespace raymo::curves
