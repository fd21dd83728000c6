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
    explicit WrappedSession(std::unique_ptr<Session> inner) : inner_(std::move(inner))
    {
        if (const std::size_t words = inner_->tally_words().size(); words > 0) make_tally(Task::tally, words / 2);
    }
    void set_rays(std::span<const Quad> quads) override { inner_->set_rays(quads); }
    void start(std::span<const TraceJob> jobs) override { inner_->launch(jobs); }
    [[nodiscard]] double wait() override { return inner_->wait(); }
    void read_output(std::span<std::uint32_t> words) override
    {
        const OutputParts parts = output_parts(HIT_WORDS);
        std::vector<Hit> hits(written_rays());
        inner_->read_back(hits);
        change(hits);
        std::fill(words.begin(), words.end(), POISON);
        const Hit* next = hits.data();
        for (std::size_t job = 0; job < written_parts(); ++job) {
            const auto results = parts.results(words, job);
            std::memcpy(results.data(), next, results.size_bytes());
            next += results.size() / HIT_WORDS;
        }
        if (inner_->tally_words().empty()) return;
        std::ranges::copy(inner_->tally_words(), parts.tally(words, 0).begin());
        change_tally(parts.tally(words, 0));
    }
    [[nodiscard]] SetupTimes setup_times() const override { return inner_->setup_times(); }
    [[nodiscard]] std::uint64_t bytes() const override { return inner_->bytes(); }

protected:
    /// What becomes of the hits that were read back.
    virtual void change(std::span<Hit>) {}
    /// The same of the words of a tally.
    virtual void change_tally(std::span<std::uint32_t>) {}
    [[nodiscard]] Session& inner() { return *inner_; }

private:
    std::unique_ptr<Session> inner_;
};

} // namespace tetrace::test
