#pragma once

#include "core/device/backend.h"

#include <string_view>

namespace tetrace {

/// The API of the pages that `tetrace page` writes. A browser runs it, so it is no Backend; results have rows of it.
inline constexpr const char* browser_api = "webgpu";

/// Whether a row of a result may name the API.
[[nodiscard]] inline bool is_known_api(std::string_view name)
{
    return name == browser_api || find_backend(name) != nullptr;
}

} // namespace tetrace
