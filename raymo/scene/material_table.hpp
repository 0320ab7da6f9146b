// The materials of a scene.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <vector>

#include "raymo/core/assert.hpp"
#include "raymo/scene/material.hpp"

namespace raymo::scene {

/// A list of materials that grows at its end. It is kept in pieces that are not moved when it grows, and that copies of the
/// list share until one of them changes: a model may have as many materials as solids. Lists that share pieces may be read in
/// any number of threads, but be changed or given up only in one.
class MaterialTable {
public:
    MaterialTable() = default;
    MaterialTable(std::initializer_list<Material> materials) {
        for (const Material& m : materials) push_back(m);
    }

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] bool empty() const { return size_ == 0; }
    [[nodiscard]] const Material& operator[](std::size_t i) const {
        return (*pieces_[i / kPiece])[i % kPiece];
    }
    void push_back(const Material& material) {
        if (size_ % kPiece == 0) {
            pieces_.push_back(made({}));
        } else {
            unshare(pieces_.back());
        }
        pieces_.back()->push_back(material);
        ++size_;
    }
    /// Default materials up to that number; no fewer than there are.
    void resize(std::size_t size) {
        RAYMO_ASSERT(size >= size_);
        while (size_ < size) push_back({});
    }
    /// To be changed; not seen by copies of the list.
    [[nodiscard]] Material& edit(std::size_t i) {
        unshare(pieces_[i / kPiece]);
        return (*pieces_[i / kPiece])[i % kPiece];
    }

    /// is(material) for some of them.
    template <class Is>
    [[nodiscard]] bool any_of(Is&& is) const {
        for (std::size_t i = 0; i < size_; ++i) {
            if (is((*this)[i])) return true;
        }
        return false;
    }

private:
    static constexpr std::size_t kPiece = 64;
    using Piece = std::vector<Material>;

    /// With room for all that a piece holds.
    static std::shared_ptr<Piece> made(const Piece& materials) {
        auto piece = std::make_shared<Piece>();
        piece->reserve(kPiece);
        piece->assign(materials.begin(), materials.end());
        return piece;
    }
    static void unshare(std::shared_ptr<Piece>& piece) {
        if (piece.use_count() > 1) piece = made(*piece);
    }

    std::vector<std::shared_ptr<Piece>> pieces_;
    std::size_t size_ = 0;
};

}  // namespace raymo::scene
