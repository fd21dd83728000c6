#pragma once

#include "tests/support/wrapped_session.h"

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace tetrace::test {

/// A launch that a session saw.
struct SeenLaunch {
    std::size_t session; ///< its number
    std::uint32_t passes;

    friend bool operator==(const SeenLaunch&, const SeenLaunch&) = default;
};

/// Notes its launches; a pass takes as many seconds as a variable says when it ends.
class TimedSession : public WrappedSession {
public:
    TimedSession(std::unique_ptr<Session> inner, std::size_t number, std::vector<SeenLaunch>& launches,
                 const double& pass_s)
        : WrappedSession(std::move(inner)), number_(number), launches_(&launches), pass_s_(&pass_s)
    {
    }
    void start(std::span<const TraceJob> jobs) override
    {
        passes_ = jobs.front().passes;
        launches_->push_back({number_, passes_});
        WrappedSession::start(jobs);
    }
    [[nodiscard]] double wait() override
    {
        static_cast<void>(WrappedSession::wait());
        return *pass_s_ * passes_;
    }

private:
    std::size_t number_;
    std::uint32_t passes_ = 1;
    std::vector<SeenLaunch>* launches_;
    const double* pass_s_;
};

} // namespace tetrace::test
