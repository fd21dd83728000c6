#pragma once

#include "core/device/backend.h"
#include "core/rays/hit.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace tetrace::test {

/// Passes every call on to another session. A test overrides what it watches, delays or damages.
class WrappedSession : public Session {
public:
    explicit WrappedSession(std::unique_ptr<Session> inner) : inner_(std::move(inner)) {}
    void set_rays(std::span<const Quad> quads) override { inner_->set_rays(quads); }
    void launch(const TraceJob& job) override { inner_->launch(job); }
    [[nodiscard]] double wait() override { return inner_->wait(); }
    void read_output(std::span<std::uint32_t> words) override
    {
        std::vector<Hit> hits((words.size() - 2 * GUARD_WORDS) / HIT_WORDS);
        inner_->read_back(hits);
        change(hits);
        std::fill(words.begin(), words.end(), POISON);
        std::memcpy(words.data() + GUARD_WORDS, hits.data(), hits.size() * sizeof(Hit));
    }
    [[nodiscard]] SetupTimes setup_times() const override { return inner_->setup_times(); }
    [[nodiscard]] std::uint64_t bytes() const override { return inner_->bytes(); }

protected:
    /// What becomes of the hits that were read back.
    virtual void change(std::span<Hit>) {}
    [[nodiscard]] Session& inner() { return *inner_; }

private:
    std::unique_ptr<Session> inner_;
};

} // namespace tetrace::test
