// How long work reports how far it is, and learns that it should stop.
#pragma once

namespace raymo {

/// Handed in by the app. Calls may come from several threads at once.
class Progress {
public:
    virtual ~Progress() = default;
    /// `fraction` of the whole work that is done, 0..1, never decreasing.
    virtual void report(double fraction) { static_cast<void>(fraction); }
    /// True once the user wants to stop; polled at least every few milliseconds of work.
    [[nodiscard]] virtual bool cancelled() const { return false; }
};

}  // namespace raymo
