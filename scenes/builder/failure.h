#pragma once

#include "scenes/builder_exit.h"

#include <stdexcept>
#include <string>

namespace tetrace {

/// A failure with its own exit code; the text says what to do.
class BuilderFailure : public std::runtime_error {
public:
    BuilderFailure(BuilderExit code, const std::string& what) : std::runtime_error(what), code_(code) {}
    [[nodiscard]] BuilderExit code() const noexcept { return code_; }

private:
    BuilderExit code_;
};

} // namespace tetrace
