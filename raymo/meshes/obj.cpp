#include "raymo/meshes/obj.hpp"

#include <charconv>

namespace raymo::meshes {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

/// Words of a line, up to a comment.
class Words {
public:
    explicit Words(std::string_view line) : rest_(line.substr(0, line.find('#'))) {}
    /// Empty at the end.
    std::string_view next() {
        std::size_t i = 0;
        while (i < rest_.size() && is_blank(rest_[i])) ++i;
        rest_.remove_prefix(i);
        i = 0;
        while (i < rest_.size() && !is_blank(rest_[i])) ++i;
        const std::string_view word = rest_.substr(0, i);
        rest_.remove_prefix(i);
        return word;
    }

private:
    std::string_view rest_;
};

template <class T>
bool read(std::string_view word, T& out) {
    if (!word.empty() && word[0] == '+') word.remove_prefix(1);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), out);
    return error == std::errc() && end == word.data() + word.size() && !word.empty();
}

std::string printable(std::string_view word) {
    std::string out;
    for (const char c : word.substr(0, 24))
        out += static_cast<unsigned char>(c) < 32 || static_cast<unsigned char>(c) > 126 ? '?' : c;
    return word.size() > 24 ? out + "..." : out;
}

Failure unreadable(std::size_t line, const std::string& what, std::string hint) {
    return fail(ErrorCode::bad_argument,
                "line " + std::to_string(line) + " of the file can not be read: " + what,
                std::move(hint));
}

class Reader {
public:
    Reader(std::string_view text, const GoOn& go_on) : text_(text), go_on_(go_on) {}

    Result<Mesh> run() {
        while (!text_.empty()) {
            if (line_ % 4096 == 0 && !go_on_(charged())) return stopped();
            const std::string_view line = next_line();
            Words words(line);
            const std::string_view word = words.next();
            if (word == "v") {
                if (auto done = point(words); !done) return Failure(std::move(done).error());
            } else if (word == "f") {
                if (auto done = face(words); !done) return Failure(std::move(done).error());
            }
            if (std::max(points_.size(), corners_) > kMostCorners) {
                return fail(ErrorCode::limit, "the mesh in the file is too large",
                            "use a coarser mesh");
            }
        }
        if (faces_.empty()) {
            return fail(ErrorCode::empty, "there are no faces in the file",
                        "a mesh in Wavefront's OBJ has lines that begin with v and f");
        }
        if (!go_on_(2.0 * charged())) return stopped();
        return make_mesh(std::move(points_), faces_);
    }

private:
    [[nodiscard]] static Failure stopped() { return fail(ErrorCode::cancelled, "stopped"); }
    [[nodiscard]] double charged() const {
        return static_cast<double>(points_.size() * sizeof(Vec3) + corners_ * sizeof(double) +
                                   faces_.size() * sizeof(decltype(faces_)::value_type));
    }

    /// Lines that end in a backslash go on in the next.
    std::string_view next_line() {
        std::string_view line;
        joined_.clear();
        for (;;) {
            ++line_;
            const std::size_t end = text_.find('\n');
            line = text_.substr(0, end);
            text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
            while (!line.empty() && line.back() == '\r') line.remove_suffix(1);
            if (line.empty() || line.back() != '\\' || text_.empty()) break;
            joined_ += line.substr(0, line.size() - 1);
            joined_ += ' ';
        }
        if (joined_.empty()) return line;
        joined_ += line;
        return joined_;
    }

    Result<void> point(Words& words) {
        Vec3 p;
        for (int i = 0; i < 3; ++i) {
            const std::string_view word = words.next();
            if (read(word, p[i])) continue;
            return unreadable(line_,
                              word.empty() ? "a point has less than three numbers"
                                           : "\"" + printable(word) + "\" is not a number",
                              "a point is written: v 1.5 0 2");
        }
        points_.push_back(p);
        return {};
    }

    /// Corners are numbers of points, of which the first is 1 and the last so far is -1; behind slashes stand others.
    Result<void> face(Words& words) {
        std::vector<double> out;
        for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
            const std::string_view number = word.substr(0, word.find('/'));
            std::int64_t n = 0;
            if (!read(number, n) || n == 0) {
                return unreadable(line_, "\"" + printable(word) + "\" is not the number of a point",
                                  "a face is written: f 1 2 3 4");
            }
            const auto count = static_cast<std::int64_t>(points_.size());
            const std::int64_t k = n > 0 ? n - 1 : count + n;
            if (k < 0 || k >= count) {
                return unreadable(line_, "there is no point " + std::to_string(n) + " before it",
                                  "points stand before the faces that name them");
            }
            out.push_back(static_cast<double>(k));
        }
        corners_ += out.size();
        if (out.size() < 3)
            return unreadable(line_, "a face has less than three corners",
                              "a face is written: f 1 2 3 4");
        faces_.push_back(std::move(out));
        return {};
    }

    std::string_view text_;
    const GoOn& go_on_;
    std::string joined_;
    std::size_t line_ = 0;
    std::vector<Vec3> points_;
    std::vector<std::vector<double>> faces_;
    std::size_t corners_ = 0;
};

}  // namespace

Result<Mesh> read_obj(std::string_view text, const GoOn& go_on) {
    return Reader(text, go_on).run();
}

}  // namespace raymo::meshes
